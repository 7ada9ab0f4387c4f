// From a description to JSON.
#pragma once

#include <string>

#include "renderer/params/node.h"
#include "renderer/scene_io/json_tree.h"

namespace brume {

struct WriteOptions {
  std::string
      target_dir;    ///< the folder the text is meant for; file parameters near it become relative. Empty: none do
  bool all = false;  ///< writes defaults too
};

/// The JSON form of one value; numbers keep every bit.
JsonValue value_to_json(const Value& value);

/// An object with the node's keys in the order of its table. A value equal to its default is left out, except required
/// parameters, a name that is not empty, and the kind. A file becomes relative to `target_dir` when it lies inside it
/// or up to two folders above and aside; otherwise its path is written as it is. read_node() with `target_dir` as its
/// base gives an equal node, if all required parameters have values and all texts are UTF-8.
/// @param family  of the node: names its type key.
JsonValue node_to_json(const Node& node, const Family& family, const WriteOptions& options);

/// The same as text, in lines of at most 100 columns where possible; ends with a newline.
std::string write_node(const Node& node, const Family& family, const WriteOptions& options);

}  // namespace brume
