// What points of a ray receive from points of lights, at SIMD width.
#pragma once

#include <cstdint>

#include "renderer/core/simd.h"
#include "renderer/lights/light_point.h"

namespace brume {

/// A point of a light in each lane, and a point of one ray that looks at it: incident() for all of them at once.
class LightLanes {
 public:
  /// What each lane is to look at.
  void set(int lane, const LightPoint& point);

  /// Makes every lane below n look from the place on the ray at its distance.
  /// @param t  world units
  void look(const Ray& ray, const LaneArray<float>& t, int n);

  /// Puts something else in the place of what a lane has seen.
  void replace(int lane, Vec3 wi, float distance, Color irradiance);

  Vec3 x(int lane) const { return vec(arrays_.x, lane); }    ///< of the point of the ray
  Vec3 wi(int lane) const { return vec(arrays_.wi, lane); }  ///< as in IncidentLight
  float distance(int lane) const { return arrays_.distance[lane]; }
  const LaneArray<float>& cosine() const { return arrays_.cosine; }  ///< between the ray and wi

  /// Normal irradiance, W/m^2, as in IncidentLight: sent * seen.
  const LaneArray<float>& sent(int channel) const { return arrays_.sent[channel]; }
  const LaneArray<float>& seen() const { return arrays_.seen; }

  /// For the loop over lanes.
  struct Arrays {
    LaneArray<float> place[3];  ///< position, or the direction towards a distant point
    LaneArray<float> normal[3];
    LaneArray<float> begin, slope;  ///< of the falloff
    LaneArray<std::int32_t> kind;   ///< the bits below
    LaneArray<float> sent[3];
    LaneArray<float> x[3], wi[3];
    LaneArray<float> distance, seen, cosine;
  };
  static constexpr int kDistant = 1, kTwoSided = 2, kSmooth = 4;

 private:
  static Vec3 vec(const LaneArray<float> a[3], int lane) { return {a[0][lane], a[1][lane], a[2][lane]}; }

  Arrays arrays_;
};

}  // namespace brume
