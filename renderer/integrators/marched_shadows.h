// Light samples and their shadow rays, marched together.
#pragma once

#include <limits>

#include "renderer/integrators/integrator.h"
#include "renderer/march/shadow_march.h"
#include "renderer/sampling/light_numbers.h"

namespace brume {

/// Collects light samples that wait for the transmittance of their shadow rays, and adds up what arrives. What a sample
/// carries is the most that it can add: where that is below a fiftieth of the mean of those it waits with, its shadow
/// ray is only traced as often as it deserves, and then counts for more (Russian roulette), so that lights too faint to
/// see cost little. Lives in the arena scope that was open when it was made.
template <int C> class MarchedShadows {
 public:
  MarchedShadows(int bounce, SampleContext& context);

  /// @param carried  what the sample adds to the radiance if nothing is in the shadow ray's way
  void add(const Light& light, const Ray& shadow, Color carried, const ShadowNumbers& numbers);

  /// Of all samples so far.
  Color light();

 private:
  static constexpr int kWaiting = 32;  // at most; with some thirty steps each they fill the look-ups' vectors
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();

  void play_roulette();
  void march();

  int bounce_;
  SampleContext& context_;
  ShadowRays rays_;
  std::span<Color> carried_;
  std::span<int> index_;
  std::span<Spectrum<C>> transmittances_;
  float carried_sum_ = 0, carried_least_ = kInfinity;  // luminances of those that wait
  Color sum_;
};

}  // namespace brume
