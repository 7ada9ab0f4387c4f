// Places on lights, and what they send out.
#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/core/ray.h"

namespace brume {

/// How what a point of a light sends out changes with the cosine c between its normal and the direction:
///   s = (c - begin) slope, kept between 0 and 1; smoothed to s^2 (3 - 2 s) inside a cone's border.
struct Falloff {
  float begin = -2, slope = 1;  // as it is here: 1 in all directions
  bool two_sided = false;       ///< counts |c|
  bool smooth = false;

  static constexpr Falloff lambertian(bool two_sided) { return {0, 1, two_sided}; }
  /// Nothing up to cos_outer, everything from cos_inner on, which may be the same.
  static Falloff cone(float cos_outer, float cos_inner) {
    return {cos_outer, std::min(1 / (cos_inner - cos_outer), 1e30f), false, true};
  }

  float operator()(float c) const {
    const float s = std::clamp(((two_sided ? std::abs(c) : c) - begin) * slope, 0.0f, 1.0f);
    return smooth ? s * s * (3 - 2 * s) : s;
  }
};

/// A place on a light, chosen before the distance along the ray, so that equi-angular sampling can be about the very
/// point that the shadow ray goes to (for a large near light the centre would be far worse). It knows what it sends
/// out, so that what arrives is one equation for all lights.
struct LightPoint {
  enum class Kind {
    Finite,       ///< `position` counts, and `normal` unless the falloff is even
    Distant,      ///< `direction` counts: unit, from the scene towards the light
    Environment,  ///< the direction is still open: the phase function draws it
  };
  Kind kind = Kind::Finite;
  Vec3 position = {};
  Vec3 direction = {};
  Vec3 normal = {};      ///< unit, of the lit side, or the axis of a cone
  Falloff falloff = {};  ///< about the normal
  Color sent = {};       ///< over the pdf of the point: of a finite one radiant intensity where the falloff is 1, W/sr;
                         ///< of a distant one normal irradiance, W/m^2
  float pdf = 0;         ///< of a finite one per area, of a distant one per sr; 0: the only point
};

/// Light arriving at a point from a LightPoint.
struct IncidentLight {
  Vec3 wi;           ///< unit, from the point towards the light
  float distance;    ///< world units; infinite for distant lights
  Color irradiance;  ///< normal irradiance, W/m^2, divided by the pdf of the light point, before any transmittance
  float pdf_w = 0;   ///< with which the light point is chosen, per sr; 0: a single direction
};

/// Nearer to a light point than this, in world units, nothing is received: 1/r^2 has no value that a float could hold.
inline constexpr float kAtTheLight = 1e-15f;

/// What `x` receives from `point`, if nothing is in between:
///   E = I falloff(cos) / r^2,   pdf_w = pdf r^2 / cos.
/// Black for environments.
IncidentLight incident(const LightPoint& point, Vec3 x);

}  // namespace brume
