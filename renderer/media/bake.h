// Procedural densities kept on voxels: looked up instead of computed.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/media/brick_grid.h"
#include "renderer/media/shader.h"
#include "renderer/params/param.h"

namespace brume {

/// The density at the voxels of a box that begins at (0,0,0): voxel (i,j,k) is at (i,j,k) * voxel, in the space of the
/// shader's points. Nothing finer than a voxel is left. On all hardware threads. Null where the density is 0 at all of
/// them.  @param size  of the box.  @param voxel  > 0.  Errors: more voxels than memory; cancelled.
Result<std::shared_ptr<const BrickGrid>> bake(const Shader& shader, Vec3d size, double voxel,
                                              const LoadOptions& options);

/// What a baked grid is made of.
struct BakeRecipe {
  std::string shader;
  std::vector<Value> values;  ///< of the shader's own parameters
  Bounds3 box;                ///< in the volume's own space, so that moving the volume bakes nothing anew
  double voxel;

  bool operator==(const BakeRecipe& other) const {
    return shader == other.shader && values == other.values && box.low == other.box.low && box.high == other.box.high &&
           voxel == other.voxel;
  }
};

/// The grids baked so far: an edit of a light must not bake the cloud again. Any thread.
class BakeCache {
 public:
  /// @param make  Result<std::shared_ptr<const BrickGrid>>(), for a recipe that is new. Nobody waits while it bakes:
  /// two threads that ask for the same at the same time both do.
  template <class Make> Result<std::shared_ptr<const BrickGrid>> load(const BakeRecipe& recipe, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      for (const Entry& e : entries_)
        if (e.recipe == recipe) return e.grid;
    }
    auto grid = make();
    const std::lock_guard lock(mutex_);
    if (grid) entries_.push_back({recipe, *grid});
    return grid;
  }

  /// Forgets what nobody else holds.
  void drop_unused() {
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& e) { return e.grid.use_count() <= 1; });
  }

 private:
  struct Entry {
    BakeRecipe recipe;
    std::shared_ptr<const BrickGrid> grid;
  };
  std::mutex mutex_;
  std::deque<Entry> entries_;
};

}  // namespace brume
