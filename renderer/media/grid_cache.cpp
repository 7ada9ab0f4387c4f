#include "renderer/media/grid_cache.h"

#include <filesystem>

namespace brume {

Result<std::shared_ptr<const LoadedGrid>> GridCache::load(const std::string& path, const std::string& grid,
                                                          const LoadOptions& options) {
  const std::lock_guard lock(mutex_);
  std::error_code no_file;  // a missing file is reported by load_grid, in better words
  const auto modified =
      std::filesystem::last_write_time(std::filesystem::path(path), no_file).time_since_epoch().count();
  const Key key{path, grid, modified};
  if (const auto known = grids_.find(key); known != grids_.end()) return known->second;
  auto loaded = load_grid(path, grid, options);
  if (!loaded) return loaded.error();
  return grids_[key] = std::make_shared<const LoadedGrid>(std::move(*loaded));
}

void GridCache::drop_unused() {
  const std::lock_guard lock(mutex_);
  std::erase_if(grids_, [](const auto& entry) { return entry.second.use_count() == 1; });
}

}  // namespace brume
