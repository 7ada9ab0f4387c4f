// Counter-based random numbers with one named dimension per decision.
#pragma once

#include <cstdint>

#include "renderer/core/vec.h"
#include "renderer/sampling/scramble.h"

namespace brume {

enum class SamplerKind {
  Independent,  ///< every number independent of every other: what statistics assume
  Sobol,        ///< the passes of a pixel follow one Owen-scrambled Sobol' sequence, whose dimensions are the decisions
};

/// What a random number decides. Two decisions never share a number: the catalogue of failures has entries for
/// renderers that used one number for the step offset and the distance, or for the light and the distance.
enum class Decision : std::uint32_t {
  Pixel,            // 2D: position inside the pixel
  MarchOffset,      // where inside every segment the medium is looked up
  ShadowOffset,     // the same on a shadow ray; per light sample
  LightChoice,      // which light, when one is picked
  LightPoint,       // 2D: where on the light; per light sample
  DensityDistance,  // distance by density sampling; per light sample
  EquiangularDistance,
  PhaseLobe,       // which medium's phase function, where media overlap; per light sample
  PhaseDirection,  // 2D: a direction towards an environment light; per light sample
  BounceDistance,
  BounceLobe,
  BounceDirection,  // 2D
  Roulette,
  TechniquePhase,     // which technique a pixel starts with when they alternate between passes
  LightByChance,      // whether a light is looked for by chance; per light sample
  BounceTechnique,    // whether a scattered ray goes about a lamp, and about which
  BounceLampPoint,    // 2D: the place on that lamp; per lamp
  Channel,            // which channel of a chromatic medium leads a path
  Flight,             // free flights of a tracked ray; per flight
  ShadowFlight,       // of a ray towards a light; per light sample and flight
  CameraFlight,       // of the camera ray towards what it sees directly
  EquiangularFlight,  // up to a distance that was drawn about a light
  RealCollision,      // whether a tentative collision is real; per flight
  MediumOrSurface,    // where a scattered ray begins
  ShadowRoulette,     // whether a faint light sample's shadow ray is traced; per light sample
};
inline constexpr int kDecisionCount = static_cast<int>(Decision::ShadowRoulette) + 1;

/// Pass number `sample` over a picture: what the samplers of its pixels have in common.
struct SamplerPass {
  SamplerPass(SamplerKind kind, std::uint64_t seed, std::uint32_t sample);

  SamplerKind kind;
  std::uint32_t sample;
  std::uint64_t seed_key;
  JointArray<std::uint32_t> digits = {};
};

/// Random numbers of one sample of one pixel. A pure function of its arguments: no state advances, so results do not
/// depend on the order of calls, on threads or on tiles.
///
/// The decisions that every camera ray takes share one point of the pass, each pixel scrambling its digits in its own
/// way: they are stratified together. What few rays decide, or far down a path, gets pairs of dimensions of its own.
/// In the first pass the 4x4 pixels of a block share their numbers out among themselves, so that the block as a whole
/// is stratified too: neighbours err in opposite directions, and the noise is fine-grained (blue), which eyes and
/// filters average away. After Ahmed & Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via
/// Hierarchical Ordering of Pixels", who order the whole picture, for a number of passes known beforehand. Later passes
/// have much less noise to share out, and pixels that were coupled in them would err alike.
class Sampler {
 public:
  /// Of pixel (x, y) of a picture.
  Sampler(const SamplerPass& pass, int x, int y, int picture_width);

  /// A pixel without neighbours.
  Sampler(SamplerKind kind, std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample);

  SamplerKind kind() const { return kind_; }
  std::uint32_t sample() const { return sample_; }

  /// In [0, 1). `bounce` counts scattered rays, `index` the light samples (or whatever repeats) at that bounce.
  float u1(Decision decision, int bounce = 0, int index = 0) const;
  Vec2 u2(Decision decision, int bounce = 0, int index = 0) const;

  /// The same in every pass of this pixel; for choices that must be random over pixels but fixed over passes.
  float per_pixel(Decision decision) const;

 private:
  Sampler(const SamplerPass& pass, const JointKeys& keys);
  std::uint64_t key_of(Decision decision, int bounce, int index) const;

  SamplerKind kind_;
  std::uint32_t sample_;
  std::uint64_t pixel_key_;
  JointArray<float> joint_;  // numbers of the decisions that share a point of the pass
};

}  // namespace brume
