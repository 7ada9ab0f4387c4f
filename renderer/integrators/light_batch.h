// Light samples of one ray, taken through their steps together.
#pragma once

#include "renderer/integrators/light_weights.h"
#include "renderer/integrators/marched_shadows.h"
#include "renderer/march/density_sampling.h"
#include "renderer/march/equiangular_lanes.h"

namespace brume {

/// The part of the record that a point of the light can reach.
template <int C>
Interval lit_part(const MarchRecord<C>& record, const Ray& ray, const Light& light, const LightPoint& point) {
  return intersect(record.span(), light.lit_part(point, {ray.origin, ray.direction, record.span()}));
}

/// Samples of the light that is scattered once along a recorded ray towards its origin. Each is a point of a light and
/// a place on the ray; what it carries, sigma_s T L_scattered over the densities, is handed to the shadows. A step of a
/// sample waits for the one before it, but not for those of other samples, so each step is made for all of them, and at
/// SIMD width unless there is more to a sample than the medium and a point of a light. Lives in the arena scope that
/// was open when it was made.
template <int C> class LightBatch {
 public:
  /// @param record  distributed, with scattered() > 0.  @param beta  throughput at its start.  @param bounce  scattered
  /// rays so far
  LightBatch(const MarchRecord<C>& record, const Ray& ray, Color beta, int bounce, SampleContext& context,
             MarchedShadows<C>& shadows);

  /// What the samples of a technique have in common.
  struct Technique {
    const Light& light;
    DistanceTechnique distance;
    float factor;   ///< one over the samples of this technique, on average over the passes
    bool combined;  ///< with the other one of MIS, which might have drawn the same distance and direction
  };

  /// The first samples of a light, at places that are drawn without regard to its points.
  /// @param places  DensitySampling or ProductSampling.  @param u  of the places.  @param count  of the samples
  template <class Places>
  void add_at(const Technique& technique, const Places& places, const LightNumbers& numbers,
              const LightNumbers::Distances& u, int count);

  /// The samples of a light from number `first` on, whose distances are drawn about their points by equi-angular
  /// sampling: about that very point the segment is chosen, and the distance, too, where the segment is homogeneous or
  /// so near to the point that 1/r^2 varies in it, and what scatters there is looked up. Elsewhere it is the place
  /// where the segment was looked up (PlaceInSegment::LookedUp), with the mean of the distribution's density over the
  /// segment.
  /// @param u  of the distances
  void add_about(const Technique& technique, const LightNumbers& numbers, const LightNumbers::Distances& u, int first,
                 int count);

  /// Takes the samples that are left through their steps.
  void finish();

 private:
  static constexpr int kCapacity = kWidestVector;
  struct Sample;

  bool is_plain(const Light& light) const;
  void add(const Technique& technique, bool plain, float u, Vec2 u_point, const ShadowNumbers& numbers);
  void put(int k, const RayPoint<C>& at, float unaimed);
  void put_looked_up(int k, int segment, float probability);
  void place_about();
  /// @return whether it was met by chance, in another point, at which the lane is aimed now
  bool look_closely(int k);
  void find_pdfs();
  void hand_over(int k);

  bool follows(int k, int segment) const {
    return record_.is_homogeneous(segment) || about_.is_near(k, record_.segment(segment));
  }

  const MarchRecord<C>& record_;
  const Ray& ray_;
  Color beta_;
  int bounce_;
  SampleContext& context_;
  MarchedShadows<C>& shadows_;
  DensitySampling<C> density_;
  Sample* samples_;                  // [kCapacity]
  LaneArray<float> t_;               // where they are
  LaneArray<std::int32_t> segment_;  // the same
  EquiangularLanes about_;           // the points of the lights, where a density about them counts
  LaneArray<float> u_;               // the numbers that will draw distances by it
  LightLanes lights_;
  LightWeights<C> weights_;
  int n_ = 0;
};

}  // namespace brume
