// What to show when somebody drops a bare grid file on the window.
#pragma once

#include "renderer/engine/engine.h"
#include "renderer/params/node.h"

namespace brume {

struct FirstLook {
  Node description;                ///< a whole scene, of scene_family()
  std::vector<std::string> notes;  ///< one sentence each: what was chosen
};

/// A scene for a .vdb or .nvdb file: its density grid guessed, the camera framed, the density scaled so that the 90th
/// percentile of the optical depth over the pixels that meet the grid is about 4, and lights that show its shape.
/// Errors are those of reading the file.
Result<FirstLook> first_look(const std::string& path, SceneCache& cache, const LoadOptions& options);

/// The scale that brings the 90th percentile of the optical depth to `target`, over rays of the scene's camera that
/// meet medium; 0 when none does. @param scene  with the density scale that the result multiplies
double density_scale_for(const Scene& scene, double target);

}  // namespace brume
