// Voxel grids read so far, shared by the scenes made of them.
#pragma once

#include <map>
#include <mutex>

#include "renderer/media/vdb_file.h"

namespace brume {

/// Reads every grid once, as long as the file does not change. Any thread; a second thread that asks for a grid being
/// read waits for it.
class GridCache {
 public:
  Result<std::shared_ptr<const LoadedGrid>> load(const std::string& path, const std::string& grid,
                                                 const LoadOptions& options);

  /// Forgets what nobody else holds.
  void drop_unused();

 private:
  struct Key {
    std::string path, grid;
    std::int64_t modified;
    auto operator<=>(const Key&) const = default;
  };
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const LoadedGrid>> grids_;
};

}  // namespace brume
