// Light sources: what the march needs of them.
#pragma once

#include <optional>

#include "renderer/lights/light_point.h"

namespace brume {

class Surface;

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

/// Whether a light that looks so large is looked for by chance, too: larger than the peak of what scatters is wide.
/// @param solid_angle  sr.  @param peak  1/sr
inline bool is_large(float solid_angle, float peak) { return solid_angle * peak > 1; }

/// Immutable; any thread.
class Light {
 public:
  virtual ~Light() = default;

  /// Of all its points.
  virtual LightPoint::Kind kind() const { return LightPoint::Kind::Finite; }

  /// @param u  uniform in [0,1)^2
  virtual LightPoint sample_point(Vec2 u) const = 0;

  /// What `x` receives from `point`, whatever is in the way but the light itself.
  IncidentLight incident(const LightPoint& point, Vec3 x) const;

  /// What keeps the light of one of its parts from shining through another; null where nothing can or need.
  virtual const Surface* own_shadow() const { return nullptr; }

  /// The part of the ray that `point` can light at all (one side of a quad, the inside of a cone).
  virtual Interval lit_part(const LightPoint& point, const Ray& ray) const;

  /// Nothing for lights without a place.
  virtual std::optional<LightPivot> pivot() const { return std::nullopt; }

  /// Radiance of an environment that is the same all around; black for every other light.
  virtual Color environment_radiance() const { return {}; }

  /// Where a ray hits the light and what it sees there.
  virtual std::optional<LightHit> hit(const Ray& ray) const;

  /// How large the light looks from x, sr, roughly; 0 for lights that no ray can hit. Falls with the distance from the
  /// pivot; of a light that has none it is the same everywhere.
  virtual float solid_angle(Vec3 x) const;

  /// At most, from anywhere on a ray or in a box.
  float largest_solid_angle(const Ray& ray) const;
  float largest_solid_angle(const Bounds3& box) const;

  bool visible_to_camera = false;
};

}  // namespace brume
