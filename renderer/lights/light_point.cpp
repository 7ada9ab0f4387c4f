#include "renderer/lights/light_point.h"

#include <limits>

namespace brume {

IncidentLight incident(const LightPoint& point, Vec3 x) {
  if (point.kind != LightPoint::Kind::Finite)
    return {point.direction, std::numeric_limits<float>::infinity(), point.sent, point.pdf};
  const Vec3 to_light = point.position - x;
  const float distance = length(to_light);
  if (!(distance > kAtTheLight)) return {{0, 0, 1}, distance, {}};
  const Vec3 wi = to_light / distance;
  const float seen = point.falloff(-dot(wi, point.normal)) / (distance * distance);
  return {wi, distance, point.sent * seen, seen > 0 ? point.pdf / seen : 0};
}

}  // namespace brume
