#include "renderer/scene/framing.h"

namespace brume {
namespace {

/// Four digits are plenty for a place to stand, and read well in the scene file.
double rounded(double v, double scale) {
  const double unit = std::pow(10.0, std::floor(std::log10(scale)) - 3);
  return std::round(v / unit) * unit;
}

Numbers rounded(Vec3d v, double scale) { return {rounded(v.x, scale), rounded(v.y, scale), rounded(v.z, scale)}; }

}  // namespace

void frame_bounds(Node& camera, const Bounds3& bounds, double aspect) {
  if (bounds.empty() || !(bounds.diagonal() > 0)) return;
  Vec3d backward = camera.vec3("position") - camera.vec3("look_at");
  backward = length(backward) > 0 ? normalize(backward) : Vec3d(0, -1, 0);
  constexpr double kMargin = 0.9;  // the sphere round a box is larger than what one sees of it
  const double half_angle = camera.number("vfov_deg") * (3.14159265358979323846 / 360);
  const double smaller_tan = std::tan(half_angle) * std::min(1.0, aspect);
  const double distance = kMargin * 0.5 * bounds.diagonal() / std::sin(std::atan(smaller_tan));
  const Vec3d center = bounds.center();
  // Values of a camera cannot be refused: they are finite because the bounds are.
  static_cast<void>(camera.set("look_at", rounded(center, bounds.diagonal())).ok());
  static_cast<void>(camera.set("position", rounded(center + backward * distance, bounds.diagonal())).ok());
}

}  // namespace brume
