// The JSON Schema of scene files: editors complete and check keys with it.
#pragma once

#include <string>

#include "renderer/params/node.h"

namespace brume {

/// The schema (draft 2020-12) of a scene whose root is of this family, as JSON text that ends with a newline. It says
/// what read_scene_text() accepts, but for comments and conditions between parameters. Titles and descriptions are the
/// labels, docs and units of the tables. Each family is defined once, in $defs.
std::string json_schema(const Family& root);

}  // namespace brume
