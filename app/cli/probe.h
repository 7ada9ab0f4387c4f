// brume probe: the radiance along one ray, as JSON.
#pragma once

#include <optional>

#include "app/cli/exit_code.h"
#include "app/cli/scene_options.h"

namespace brume {

struct ProbeOptions {
  SceneOptions scene;
  Vec3d origin;                 ///< world space
  Vec3d direction;              ///< unit
  double t_min = 0;             ///< world units along the unit direction
  std::optional<double> t_max;  ///< none: no end
  std::uint64_t samples = 1024;
  int threads = 0;  ///< 0: as many as the machine has
};

/// Forces the independent sampler, whatever the scene says: a standard error needs independent samples.
Result<ExitCode> run_probe(const ProbeOptions& options);

/// "ox,oy,oz,dx,dy,dz" into origin and direction, which may have any length but 0.
Result<void> parse_ray(const std::string& text, ProbeOptions& options);

}  // namespace brume
