// Voxel grids read so far, shared by the scenes made of them.
#pragma once

#include "renderer/core/file_cache.h"
#include "renderer/media/vdb_file.h"

namespace brume {

/// Reads every grid once, as long as the file does not change. Any thread.
class GridCache {
 public:
  Result<std::shared_ptr<const LoadedGrid>> load(const std::string& path, const std::string& grid,
                                                 const LoadOptions& options) {
    const auto read = [&](const std::string&) -> Result<std::shared_ptr<const LoadedGrid>> {
      auto loaded = load_grid(path, grid, options);
      if (!loaded) return loaded.error();
      return std::make_shared<const LoadedGrid>(std::move(*loaded));
    };
    return grids_.load(path, read, grid + (options.full_precision ? " full" : " half"));
  }

  /// Forgets what nobody else holds.
  void drop_unused() { grids_.drop_unused(); }

 private:
  FileCache<LoadedGrid> grids_;
};

}  // namespace brume
