// The grids of a .vdb or .nvdb file, described.
#pragma once

#include <string>
#include <vector>

#include "renderer/media/vdb_file.h"

namespace brume {

/// @param grids  of list_grids(file, true)
std::string grids_as_text(const std::string& file, const std::vector<GridInfo>& grids);
std::string grids_as_json(const std::string& file, const std::vector<GridInfo>& grids);

}  // namespace brume
