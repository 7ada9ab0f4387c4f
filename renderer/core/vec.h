// Points, directions and colours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace brume {

/// Three components: a point (world units), a vector or a unit direction, as the name of the variable says.
template <class T> struct Vec3T {
  T x{}, y{}, z{};

  constexpr Vec3T() = default;
  constexpr Vec3T(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  explicit constexpr Vec3T(T all) : x(all), y(all), z(all) {}
  template <class U>
  explicit constexpr Vec3T(const Vec3T<U>& v)
      : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

  constexpr T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const Vec3T&) const = default;
};

using Vec3 = Vec3T<float>;
using Vec3d = Vec3T<double>;

template <class T> constexpr Vec3T<T> operator+(Vec3T<T> a, Vec3T<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> constexpr Vec3T<T> operator-(Vec3T<T> a, Vec3T<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> constexpr Vec3T<T> operator-(Vec3T<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T> constexpr Vec3T<T> operator*(Vec3T<T> a, T s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T> constexpr Vec3T<T> operator*(T s, Vec3T<T> a) { return a * s; }
template <class T> constexpr Vec3T<T> operator/(Vec3T<T> a, T s) { return {a.x / s, a.y / s, a.z / s}; }

template <class T> constexpr T dot(Vec3T<T> a, Vec3T<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> constexpr Vec3T<T> cross(Vec3T<T> a, Vec3T<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> constexpr T length_squared(Vec3T<T> a) { return dot(a, a); }
template <class T> T length(Vec3T<T> a) { return std::sqrt(dot(a, a)); }
template <class T> Vec3T<T> normalize(Vec3T<T> a) { return a / length(a); }
template <class T> constexpr Vec3T<T> min(Vec3T<T> a, Vec3T<T> b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T> constexpr Vec3T<T> max(Vec3T<T> a, Vec3T<T> b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T> bool is_finite(Vec3T<T> a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

struct Vec2 {
  float x = 0, y = 0;
};

/// Linear radiometric values of three channels (red, green, blue); multiplied component by component.
struct Color {
  float r = 0, g = 0, b = 0;

  constexpr Color() = default;
  constexpr Color(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {}
  explicit constexpr Color(float all) : r(all), g(all), b(all) {}

  constexpr float operator[](int channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
  constexpr float& operator[](int channel) { return channel == 0 ? r : channel == 1 ? g : b; }
  constexpr bool operator==(const Color&) const = default;
  constexpr Color& operator+=(Color o) { return r += o.r, g += o.g, b += o.b, *this; }
  constexpr Color& operator*=(Color o) { return r *= o.r, g *= o.g, b *= o.b, *this; }
  constexpr Color& operator*=(float s) { return r *= s, g *= s, b *= s, *this; }
};

constexpr Color operator+(Color a, Color b) { return a += b; }
constexpr Color operator-(Color a, Color b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Color operator*(Color a, Color b) { return a *= b; }
constexpr Color operator*(Color a, float s) { return a *= s; }
constexpr Color operator*(float s, Color a) { return a *= s; }
constexpr Color operator/(Color a, float s) { return a * (1 / s); }
constexpr float mean(Color a) { return (a.r + a.g + a.b) * (1.0f / 3); }
constexpr float max_channel(Color a) { return std::max({a.r, a.g, a.b}); }
constexpr bool is_black(Color a) { return a.r == 0 && a.g == 0 && a.b == 0; }
constexpr bool is_grey(Color a) { return a.r == a.g && a.g == a.b; }
inline bool is_finite(Color a) { return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b); }
/// Luminance of linear Rec. 709 / sRGB primaries (ITU-R BT.709-6, item 3.2).
constexpr float luminance(Color a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

constexpr float kPi = 3.14159265358979323846f;
constexpr float kInv4Pi = 0.07957747154594766788f;

/// Two unit vectors that complete the unit vector `n` to an orthonormal frame.
/// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
struct Frame {
  Vec3 s, t, n;
  explicit Frame(Vec3 n_) : n(n_) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1 / (sign + n.z);
    const float b = n.x * n.y * a;
    s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
    t = {b, sign + n.y * n.y * a, -n.y};
  }
  Vec3 to_world(Vec3 v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace brume
