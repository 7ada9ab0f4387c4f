#include "app/session/camera_moves.h"

#include <algorithm>
#include <cmath>

namespace brume {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;

struct View {
  Vec3d position, look_at, up;  // up is unit
  explicit View(const Node& camera)
      : position(camera.vec3("position")), look_at(camera.vec3("look_at")), up(normalize(camera.vec3("up"))) {}
  Vec3d backward() const { return position - look_at; }
  Vec3d right() const { return normalize(cross(up, backward())); }
};

void put(Node& camera, const char* key, Vec3d v) {
  if (is_finite(v)) static_cast<void>(camera.set(key, Numbers{v.x, v.y, v.z}).ok());
}

/// v turned by an angle about a unit axis (Rodrigues 1840).
Vec3d turned(Vec3d v, Vec3d axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

}  // namespace

void orbit(Node& camera, double right, double up) {
  const View view(camera);
  const Vec3d backward = view.backward();
  const double elevation = std::asin(std::clamp(dot(normalize(backward), view.up), -1.0, 1.0));
  constexpr double kPole = kHalfPi - 0.01;
  const double raised = std::clamp(elevation + up, -kPole, kPole) - elevation;
  const Vec3d lifted = turned(backward, view.right(), -raised);
  put(camera, "position", view.look_at + turned(lifted, view.up, -right));
}

void pan(Node& camera, double right, double up) {
  const View view(camera);
  const double height = 2 * length(view.backward()) * std::tan(camera.number("vfov_deg") * kHalfPi / 180);
  const Vec3d screen_up = normalize(cross(view.backward(), view.right()));
  const Vec3d shift = view.right() * (right * height) + screen_up * (up * height);
  put(camera, "position", view.position + shift);
  put(camera, "look_at", view.look_at + shift);
}

void dolly(Node& camera, double factor) {
  const View view(camera);
  put(camera, "position", view.look_at + view.backward() * factor);
}

}  // namespace brume
