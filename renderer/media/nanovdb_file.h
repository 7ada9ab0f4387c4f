// Voxel grids from .nvdb files; called through vdb_file.h.
#pragma once

#include "renderer/media/vdb_file.h"

namespace brume {

/// As list_grids() and load_grid(). float, double, int32, int64 and the packed kinds Fp4, Fp8, Fp16, FpN.
/// NanoVDB files are images of memory, so nothing in them is followed unchecked: nodes are read in the order in which
/// they lie, and stray positions end as an error of build_brick_grid().
Result<std::vector<GridInfo>> list_nanovdb_grids(const std::string& path, bool scan_values);
Result<LoadedGrid> load_nanovdb_grid(const std::string& path, const std::string& grid_name, const LoadOptions& options);

}  // namespace brume
