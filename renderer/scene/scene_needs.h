// "Model no more than a scene needs", as a type.
#pragma once

#include <string>

namespace brume {

/// Asked once when a scene is committed; selects what the hot path is compiled for, and is shown to the user.
struct SceneNeeds {
  int channels = 1;           ///< 1 where every medium scatters and absorbs the same in all channels, else 3
  bool emission = false;      ///< some medium glows
  bool overlap = false;       ///< several media may share a point
  bool lookups = false;       ///< some medium is heterogeneous: rays are marched, not integrated in one segment
  bool baked = false;         ///< some procedural density is looked up on voxels instead of computed
  bool equiangular = false;   ///< some light has a position
  bool product = false;       ///< and product sampling draws among segments for it, in homogeneous media too
  bool large_lights = false;  ///< some light looks so large from the media that it is looked for by chance
  bool surfaces = false;
  bool time = false;

  bool operator==(const SceneNeeds&) const = default;

  /// "grey, static, no surfaces: 1 channel, no Embree"
  std::string to_string() const;
};

}  // namespace brume
