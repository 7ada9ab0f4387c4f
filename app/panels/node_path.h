// Where in a description an object stands.
#pragma once

#include <string>
#include <vector>

#include "renderer/params/node.h"

namespace brume {

/// From the root: "lights" 2, or "volumes" 0 and "phase". Stays meaningful when the description is replaced by an
/// edited copy, unlike a pointer.
class NodePath {
 public:
  NodePath() = default;

  NodePath child(const std::string& slot, std::size_t index = 0) const {
    NodePath path = *this;
    path.steps_.push_back({slot, index});
    return path;
  }

  /// Null when there is no such object (any more).
  const Node* find(const Node& root) const;
  Node* find(Node& root) const { return const_cast<Node*>(find(static_cast<const Node&>(root))); }

  /// As --set and variants name it: "lights.key", or "lights.2" where the name says not which. The object need not be
  /// there: a variant may have another kind, with other parts.
  std::string to_text(const Node& root) const;

  bool operator==(const NodePath&) const = default;

 private:
  struct Step {
    std::string slot;
    std::size_t index;
    bool operator==(const Step&) const = default;
  };
  std::vector<Step> steps_;
};

}  // namespace brume
