// Upper bounds of the extinction, for tracking.
#pragma once

#include <vector>

#include "renderer/core/arena.h"
#include "renderer/media/medium.h"

namespace brume {

/// A part of a ray on which the extinction does not exceed `majorant`.
struct MajorantStretch {
  Interval span;
  Color majorant;  ///< 1/world unit, >= sigma_t in each channel
};

/// Boxes that fill the scene's bounds, each with an upper bound of sigma_t (summed over the media) inside. One box is
/// the global majorant of Raab et al. 2006; many are the local ones of Yue et al. 2010, "Unbiased, Adaptive Stochastic
/// Sampling for Rendering Inhomogeneous Participating Media", in a plain grid. Where media glow, the majorant is at
/// least 4 over the scene's diagonal, so that emission is met in thin media too. Immutable; any thread.
class Majorants {
 public:
  Majorants() = default;
  /// @param bounds  of the media, scene space.  @param cells  along the longest side of the bounds, >= 1
  Majorants(std::span<const Medium> media, const Bounds3& bounds, int cells);

  /// The ray's stretches, in order of t, none empty; they cover its part inside the bounds. Lives in the arena.
  std::span<const MajorantStretch> along(const Ray& ray, Arena& arena) const;

 private:
  Color& cell(int x, int y, int z);

  Vec3 low_, cell_size_;
  int extent_[3] = {0, 0, 0};
  std::vector<Color> values_;
};

}  // namespace brume
