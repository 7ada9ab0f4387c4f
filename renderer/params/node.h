// A description: plain values shaped by parameter tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/core/vec.h"
#include "renderer/params/param.h"

namespace brume {

struct Family;

/// A place inside an object for another object ("phase") or for a list of them ("lights").
struct Slot {
  std::string key, label, doc;
  const Family* family;
  bool list = false;
};

/// What one kind of object has: its parameters, in the order people read them, and the objects inside it.
struct ParamTable {
  std::string key;    ///< the kind: "point", "vdb", "camera"
  std::string label;  ///< "Point light"
  std::string doc;
  std::vector<Param> params;
  std::vector<Slot> slots;

  const Param* find(std::string_view param_key) const;
  const Slot* find_slot(std::string_view slot_key) const;
};

/// Kinds of object that can stand in the same place. The file says which by `type_key` ("type": "point"); a family of
/// one kind has an empty type_key.
struct Family {
  std::string noun;  ///< "light", for messages
  std::string type_key;
  std::vector<const ParamTable*> tables;  ///< the first is the default

  const ParamTable* find(std::string_view kind) const;
  std::vector<std::string> kinds() const;
};

/// One object of a description: a value for every parameter of its table and a node for every slot.
/// Copying is deep and cheap (undo keeps whole copies). Reading a key that the table does not have is a logic error.
class Node {
 public:
  explicit Node(const ParamTable& table);

  const ParamTable& table() const { return *table_; }
  const std::string& kind() const { return table_->key; }

  const Value& value(std::string_view key) const;
  /// Validates; on error nothing changes.
  Result<void> set(std::string_view key, Value value);

  bool is_auto(std::string_view key) const;
  bool flag(std::string_view key) const;
  int integer(std::string_view key) const;
  double number(std::string_view key) const;
  const std::string& text(std::string_view key) const;  ///< text, file and choice
  const Numbers& numbers(std::string_view key) const;
  const Settings& settings(std::string_view key) const;
  Vec3d vec3(std::string_view key) const;
  Color color(std::string_view key) const;

  const Node& child(std::string_view slot) const;
  Node& child(std::string_view slot);
  std::span<const Node> list(std::string_view slot) const;
  std::vector<Node>& list(std::string_view slot);

  /// The same place filled with another kind; values that differ from their default, and children, are kept
  /// where both kinds know them.
  Node converted_to(const ParamTable& kind) const;

  bool operator==(const Node& other) const = default;

 private:
  std::size_t slot_index(std::string_view slot) const;

  const ParamTable* table_;
  std::vector<Value> values_;                // as table_->params
  std::vector<std::vector<Node>> children_;  // as table_->slots; one node where the slot is no list
};

/// One value somewhere below a node.
struct ParamRef {
  Node* node;
  const Param* param;
};

/// Finds "render.step_size", "lights.key.intensity", "lights.0.intensity". Errors list the valid words.
Result<ParamRef> find_param(Node& root, std::string_view path);

/// Sets by path from text, as --set does: ("render.step_size", "0.1"). A path that ends in a type key
/// ("volumes.plume.phase.type") changes the kind of that object.
Result<void> set_by_path(Node& root, std::string_view path, std::string_view text);

/// The text that set_by_path would take to leave everything as it is: a value, or a kind.
Result<std::string> text_by_path(Node& root, std::string_view path);

}  // namespace brume
