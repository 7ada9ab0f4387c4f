// A volume of the scene file: shader x bounds x transform, with optical coefficients and a phase function.
#pragma once

#include "renderer/media/medium.h"
#include "renderer/params/node.h"
#include "renderer/phase/phase_function.h"
#include "renderer/scene/scene_cache.h"

namespace brume {

/// One table per shader: what all volumes have, round what the shader has.
const Family& volume_family();

struct MadeVolume {
  Medium medium;
  std::unique_ptr<const PhaseFunction> phase;
  Bounds3 bounds;  ///< scene space
  std::vector<std::string> warnings;
};

/// @param volume  of volume_family().  @param scene_origin  world position that is (0,0,0) of the scene
/// Reads files through the cache.  Errors name the key below the volume.
Result<MadeVolume> make_volume(const Node& volume, Vec3d scene_origin, SceneCache& cache, const LoadOptions& options);

}  // namespace brume
