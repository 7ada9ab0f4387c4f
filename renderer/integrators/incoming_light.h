// Light of one lamp arriving at a scattering point.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/integrators/phase_mixture.h"
#include "renderer/integrators/scatterer.h"

namespace brume {

/// One direction in which a light is looked for. What the point scatters towards the ray's origin is estimated by
/// `scattered` times the transmittance along `wi` up to `distance`.
struct IncomingLight {
  Vec3 wi;             ///< unit
  float distance = 0;  ///< world units; infinite for lights without a place
  Color scattered;     ///< Scatterer's value times radiance over pdf; black where there is nothing to see, or a surface
                       ///< in between
  float pdf_ratio = 1;     ///< density of drawing wi at this point, over that of drawing it by a point of the light
  bool by_chance = false;  ///< drawn by the scatterer
};

/// Draws directions from vertices of a path towards one light. Where the light looks larger than the peak of what
/// scatters is wide, half of the directions are drawn by the scatterer instead and hit the light by chance; the two are
/// combined by the balance heuristic (Veach & Guibas 1995, "Optimally Combining Sampling Techniques", one sample). An
/// environment that is the same all around is only ever met by chance.
template <int C> class LightTechnique {
 public:
  /// @param bounce, index  of the light sample, for its random numbers
  LightTechnique(const Light& light, SampleContext& context, int bounce, int index)
      : light_(light), context_(context), bounce_(bounce), index_(index) {}

  /// A direction from x, by chance or towards `point`, which was drawn beforehand.
  /// @param point  becomes the one that was met, where that is another one
  template <Scatterer<C> S> IncomingLight draw(LightPoint& point, Vec3 x, const S& scatterer) const;

  /// The direction towards `point`, for a caller who has drawn x about that very point; carries the scatterer's value
  /// times radiance over the pdf of the point alone, and the pdf_ratio that draw() has there.
  template <Scatterer<C> S> IncomingLight towards(const LightPoint& point, Vec3 x, const S& scatterer) const;

 private:
  template <Scatterer<C> S>
  IncomingLight by_point(const LightPoint& point, Vec3 x, const S& scatterer, float share, bool combined) const;
  float chance_share(Vec3 x, float peak) const;
  void hide(IncomingLight& in, Vec3 x) const;

  const Light& light_;
  SampleContext& context_;
  int bounce_, index_;
};

}  // namespace brume
