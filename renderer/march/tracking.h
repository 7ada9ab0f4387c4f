// Tentative collisions: what all unbiased trackers walk along.
#pragma once

#include "renderer/core/spectrum.h"
#include "renderer/march/march_record.h"
#include "renderer/march/presence.h"
#include "renderer/media/majorants.h"
#include "renderer/sampling/sampler.h"

namespace brume {

/// A point at which the fictitious medium, whose extinction is the majorant everywhere, has collided with the ray. What
/// is really there decides whether the collision is real: sigma_t / majorant is the probability.
template <int C> struct Collision {
  float t;  ///< world units
  float majorant;
  Spectrum<C> sigma_t, sigma_s;      ///< 1/world unit
  Color emission;                    ///< W/(sr m^3)
  std::span<const float> densities;  ///< of the media, where there are several; in the arena, until the next batch
};

/// Which random numbers a ray's free flights are made of.
struct FlightNumbers {
  const Sampler& sampler;
  Decision decision;
  int bounce, index;

  float next(int j) const { return sampler.u1(decision, bounce, (index << 16) + j); }
};

/// After as many free flights a ray's majorant is lowered, so that about as many again take it to its end: one voxel of
/// 1e30 holds nothing up. Where there is more than that, transmittance is taken as 0 at the first collision.
inline constexpr int kMaxFlights = 1 << 14;

/// The tentative collisions of one ray, one after the other: distances are exponential in the optical depth of the
/// majorant. Where the collisions are does not depend on what is found there, so they are drawn and looked up in
/// batches, which grow as long as they are used up. Woodcock et al. 1965; Raab, Seibert & Keller 2006, "Unbiased Global
/// Illumination with Participating Media". Everything lies in the arena of the scope that was open at construction.
template <int C> class TentativeCollisions {
 public:
  TentativeCollisions(std::span<const Medium> media, const Majorants& majorants, const Ray& ray, float time,
                      const FlightNumbers& numbers, Arena& arena, MarchCounts& counts);

  /// The next one; null when the ray has left the media.
  const Collision<C>* next();

  /// From the last collision on, nothing in this channel matters any more: its majorant is left out.
  void drop(int channel);

  /// Whether the majorant had to be lowered.
  bool limited() const { return drawn_ > kMaxFlights; }

 private:
  static constexpr int kLargestBatch = 16;

  void fill();
  bool fly(float& t, float& majorant);

  std::span<const Medium> media_;
  Ray ray_;
  float time_;
  FlightNumbers numbers_;
  Arena& arena_;
  MarchCounts& counts_;
  Presence presence_;
  std::span<const MajorantStretch> stretches_;
  std::size_t stretch_ = 0;
  struct End {
    double at;
    std::size_t stretch;
  };
  End ends_[kLargestBatch];  // of the flights of the batch
  double here_ = 0;          // of the last collision that was handed out
  std::size_t here_stretch_ = 0;
  double at_ = 0;  // where the last flight ended; flights may be shorter than a float's spacing
  int drawn_ = 0;  // numbers used
  float limit_ = std::numeric_limits<float>::infinity();  // of the majorant

  std::span<Collision<C>> batch_;
  std::span<float> densities_;  // [kLargestBatch][media], where there are several
  int size_ = 0, used_ = 0, capacity_ = 2;
  bool dropped_[C] = {};
};

/// What is at one point of a ray; its majorant is not set. The densities lie in the arena.
template <int C>
Collision<C> collision_at(std::span<const Medium> media, const Ray& ray, float t, float time, Arena& arena,
                          MarchCounts& counts);

/// Transmittance of ray.span by ratio tracking (Novak, Selle & Jarosz 2014, "Residual Ratio Tracking", section 3): the
/// product of 1 - sigma_t / majorant over the tentative collisions. Unbiased, all channels at once.
template <int C>
Spectrum<C> ratio_tracking(std::span<const Medium> media, const Majorants& majorants, const Ray& ray, float time,
                           const FlightNumbers& numbers, Arena& arena, MarchCounts& counts);

}  // namespace brume
