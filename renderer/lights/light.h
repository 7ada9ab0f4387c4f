// Light sources: what the march needs of them.
#pragma once

#include <optional>

#include "renderer/core/ray.h"

namespace brume {

/// A place on a light, chosen before the distance along the ray, so that equi-angular sampling can be about the very
/// point that the shadow ray goes to (for a large near light the centre would be far worse).
struct LightPoint {
  enum class Kind {
    Finite,       ///< `position` counts, and `normal` on lights with a surface
    Distant,      ///< `direction` counts: unit, from the scene towards the light
    Environment,  ///< the direction is still open: the phase function draws it
  };
  Kind kind = Kind::Finite;
  Vec3 position;
  Vec3 direction;
  Vec3 normal;  ///< unit, of the lit side
};

/// Light arriving at a point from a LightPoint.
struct IncidentLight {
  Vec3 wi;           ///< unit, from the point towards the light
  float distance;    ///< world units; infinite for distant lights
  Color irradiance;  ///< normal irradiance, W/m^2, divided by the pdf of the light point, before any transmittance
  float pdf_w = 0;   ///< with which sample_point() chooses this direction, per sr; 0: a single direction
};

/// Nearer to a light point than this, in world units, nothing is received: 1/r^2 has no value that a float could hold.
inline constexpr float kAtTheLight = 1e-15f;

/// Share of the way to a light point at which a shadow ray ends, short of the surface that the point is on.
inline constexpr float kJustBefore = 1 - 1e-4f;

/// A ray meeting a light.
struct LightHit {
  float t;          ///< infinite for environments
  Color radiance;   ///< W/(sr m^2)
  float pdf_w = 0;  ///< with which sample_point() would have chosen this direction from the ray's origin, per sr
  LightPoint point = {};
};

/// Where a light with a place is, roughly: what points may receive from it is weighed by this.
struct LightPivot {
  Vec3 position;
  float radius = 0;  ///< world units: nearer than this 1/r^2 no longer tells what is received
  Vec3 normal = {};  ///< unit, of the lit side of a flat light; 0 for others
  bool two_sided = false;
  Color intensity = {};  ///< W/sr, along the normal of a flat light
};

/// Immutable; any thread.
class Light {
 public:
  virtual ~Light() = default;

  /// Of all its points.
  virtual LightPoint::Kind kind() const { return LightPoint::Kind::Finite; }

  /// @param u  uniform in [0,1)^2
  virtual LightPoint sample_point(Vec2 u) const = 0;

  /// What `x` receives from `point`; only for Finite and Distant points.
  virtual IncidentLight incident(const LightPoint& point, Vec3 x) const = 0;

  /// The part of the ray that `point` can light at all (one side of a quad, the inside of a cone).
  virtual Interval lit_part(const LightPoint& point, const Ray& ray) const;

  /// Nothing for lights without a place.
  virtual std::optional<LightPivot> pivot() const { return std::nullopt; }

  /// Radiance of an environment that is the same all around; black for every other light.
  virtual Color environment_radiance() const { return {}; }

  /// Where a ray hits the light and what it sees there.
  virtual std::optional<LightHit> hit(const Ray& ray) const;

  /// How large the light looks from x, sr, roughly; 0 for lights that no ray can hit.
  virtual float solid_angle(Vec3 x) const;

  bool visible_to_camera = false;
};

}  // namespace brume
