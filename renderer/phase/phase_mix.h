#pragma once

#include "renderer/phase/draine.h"
#include "renderer/phase/henyey_greenstein.h"

namespace brume {

/// (1 - share) * first + share * second.
template <class First, class Second> class PhaseMix final : public PhaseFunction {
 public:
  /// @param share  of the second, in [0, 1]
  PhaseMix(First first, Second second, float share) : first_(first), second_(second), share_(share) {}

  float value(float cos_theta) const override {
    return (1 - share_) * first_.value(cos_theta) + share_ * second_.value(cos_theta);
  }

  PhaseSample sample(Vec3 direction, Vec2 u) const override {
    // What is left of u.x after the choice is as good as new.
    const bool second = u.x >= 1 - share_;
    u.x = second ? (u.x - (1 - share_)) / share_ : u.x / (1 - share_);
    u.x = std::min(u.x, 0x1.fffffep-1f);
    const Vec3 drawn = (second ? second_.sample(direction, u) : first_.sample(direction, u)).direction;
    return {drawn, value(dot(direction, drawn))};
  }

  float mean_cosine() const override { return (1 - share_) * first_.mean_cosine() + share_ * second_.mean_cosine(); }

 private:
  First first_;
  Second second_;
  float share_;
};

/// A forward and a backward (or broad) lobe, as Kattawar 1975 fits clouds with.
using TwoLobe = PhaseMix<HenyeyGreenstein, HenyeyGreenstein>;

/// Henyey-Greenstein and Draine: water droplets of fog and clouds.
using Droplets = PhaseMix<HenyeyGreenstein, Draine>;

/// Jendersie & d'Eon 2023, "An Approximate Mie Scattering Function for Fog and Cloud Rendering": their
/// fit to Mie scattering by water droplets, for diameters from 5 and from 1.5 micrometres on.
/// @param diameter  micrometres, in [1.5, 50]
Droplets water_droplets(float diameter);

}  // namespace brume
