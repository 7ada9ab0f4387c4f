// Where the inspector's edits go: to the scene, or to a variant of it.
#pragma once

#include <optional>

#include "app/panels/node_path.h"
#include "app/session/session.h"

namespace brume {

/// For one frame. A variant shows the values that it renders with, and an edit becomes one of its settings; what all
/// variants have in common is edited in the scene.
class EditTarget {
 public:
  /// @param variant  of the description's "compare.variants"; none, or one that is not there: the scene
  EditTarget(Session& session, std::optional<std::size_t> variant);

  Session& session() const { return session_; }
  /// With the variant's settings; another one after every edit.
  const Node& description() const { return resolved_ ? *resolved_ : session_.description(); }
  /// The parameter's path as settings name it: "render.step_size".
  std::string path_of(const NodePath& object, const std::string& key) const;
  /// The edit of this parameter would become a setting of the variant.
  bool goes_to_variant(const NodePath& object, const std::string& key) const;
  /// The variant has a setting of its own.
  bool is_set(const NodePath& object, const std::string& key) const;

  void set(const NodePath& object, const Param& param, const Value& value);
  void set_kind(const NodePath& object, const Family& family, const ParamTable& kind);
  /// The default, or as in the scene again.
  void reset(const NodePath& object, const Param& param);

 private:
  void change(const std::function<void(Node&)>& edit);
  void resolve();

  Session& session_;
  std::optional<std::size_t> variant_;
  std::optional<Node> resolved_;  // the variant's description; none: the scene's
};

}  // namespace brume
