// The immutable thing that renders.
#pragma once

#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include "renderer/camera/pinhole_camera.h"
#include "renderer/core/log.h"
#include "renderer/lights/light.h"
#include "renderer/media/majorants.h"
#include "renderer/media/medium.h"
#include "renderer/phase/phase_function.h"
#include "renderer/scene/scene_cache.h"
#include "renderer/scene/scene_needs.h"
#include "renderer/scene/settings.h"
#include "renderer/surfaces/surfaces.h"

namespace brume {

/// A committed description. Never changes; readers hold a shared_ptr<const Scene>.
struct Scene {
  static constexpr int kMaxLampsInside = 8;

  std::uint64_t generation = 0;  ///< no two scenes of a session have the same; a later one has a higher number
  PinholeCamera camera;
  FilmSettings film;
  RenderSettings render;
  float step_size = 1;         ///< world units, resolved
  float shadow_step_size = 1;  ///< world units, resolved
  int light_samples = 1;       ///< of each light on a camera ray, resolved

  std::vector<Medium> media;                                 // enabled volumes
  std::vector<std::unique_ptr<const PhaseFunction>> phases;  ///< of the media, in their order
  std::vector<std::unique_ptr<const Light>> lights;          // enabled lights; then the surfaces that shine
  std::unique_ptr<const Surfaces> surfaces;                  // null without any
  std::vector<const Light*>
      lamps_inside;      ///< lights with a place in or near a medium, none with a surface, at most kMaxLampsInside
  Majorants majorants;   ///< of all media
  float phase_peak = 0;  ///< largest value of any phase function, 1/sr

  SceneNeeds needs;
  Bounds3 bounds;  ///< of all media, scene space; empty when there are none

  /// World position of the scene's (0,0,0). Media far from the world's origin are brought near the scene's, in double,
  /// because float coordinates 1e5 away are 0.008 apart.
  Vec3d origin = {};

  /// Of all media's grids.
  std::size_t grid_bytes() const {
    std::size_t bytes = 0;
    for (const Medium& m : media) bytes += m.shader->memory_bytes();
    return bytes;
  }

  std::vector<std::string> warnings;  ///< one sentence each: what was mended in the input
};

struct CommitOptions {
  std::uint64_t generation = 1;
  std::function<void(float)> progress = {};  ///< 0..1 while files are read; any thread
  std::stop_token cancel = {};
};

/// Makes the scene that a description describes. Heavy parts come from the cache when they are known.
/// @param description  of the scene family.  Errors name the key: "volumes.plume.file".
Result<std::shared_ptr<const Scene>> commit(const Node& description, SceneCache& cache, const CommitOptions& options);

/// Tables of the whole description. The render settings' family is handed in by the integrators, which are above.
ParamTable scene_table(const Family& render_family);

}  // namespace brume
