// Where a path goes on after it has been scattered.
#pragma once

#include "renderer/integrators/integrator.h"
#include "renderer/integrators/phase_mixture.h"
#include "renderer/integrators/scatterer.h"

namespace brume {

template <int C> struct ScatteredDirection {
  Vec3 direction;      ///< unit
  Spectrum<C> weight;  ///< the scatterer's value over the pdf of the direction
};

/// Draws the direction of a scattered ray at x. Normally that is the scatterer's own, with weight 1 for a single
/// medium. With lamps inside the medium it is not enough: what a ray gathers grows as 1/D where it passes a lamp at the
/// distance D, so the variance of every order from the second on diverges (logarithmically, for point lights). Then
/// half of the directions are uniform in the angle alpha about the direction to a lamp, pdf 1 / (2 pi^2 sin(alpha)),
/// which makes up for the 1/D, and the two are combined by the balance heuristic. Georgiev, Krivanek, Hachisuka,
/// Nowrouzezahrai, Jarosz 2013, "Joint Importance Sampling of Low-Order Volumetric Scattering", section 5.
template <int C, Scatterer<C> S>
ScatteredDirection<C> scatter_direction(const S& scatterer, Vec3 x, int bounce, const SampleContext& context);

}  // namespace brume
