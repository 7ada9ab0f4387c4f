// From JSON to a description.
#pragma once

#include <string>

#include "renderer/params/node.h"
#include "renderer/scene_io/json_tree.h"

namespace brume {

struct ReadContext {
  std::string file;      ///< the source that errors name
  std::string base_dir;  ///< what relative paths in file parameters start from; empty is the current directory
};

/// Reads an object of one of the family's kinds. What the JSON leaves out keeps its default.
/// - The kind is the value of the family's type key; without one it is the first kind.
/// - A whole number is one without a fraction (3, 3.0, 3e0). A single number for a vector or a colour means the same in
///   all three. "auto" stands where the parameter allows it.
/// - File parameters that are relative become absolute and lexically normal; an empty or absolute path stays as it is.
/// @return the first mistake, in the order of the file, with file, line, column and the key ("lights[1].intensity"):
///         an unknown kind or key, a wrong type or range, a required parameter that is missing.
Result<Node> read_node(const JsonValue& json, const Family& family, const ReadContext& context);

}  // namespace brume
