// Affine maps.
#pragma once

#include <cmath>
#include <optional>

#include "renderer/core/bounds.h"
#include "renderer/core/vec.h"

namespace brume {

/// x -> A x + b, with A given by rows. Composed in double, used in float.
template <class T> struct AffineT {
  Vec3T<T> row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3T<T> offset = {};

  Vec3T<T> vector(Vec3T<T> v) const { return {dot(row[0], v), dot(row[1], v), dot(row[2], v)}; }
  Vec3T<T> point(Vec3T<T> p) const { return vector(p) + offset; }
  /// Column j of A: the image of axis j.
  Vec3T<T> axis(int j) const { return {row[0][j], row[1][j], row[2][j]}; }
  T determinant() const { return dot(row[0], cross(row[1], row[2])); }

  template <class U> AffineT<U> cast() const {
    return {{Vec3T<U>(row[0]), Vec3T<U>(row[1]), Vec3T<U>(row[2])}, Vec3T<U>(offset)};
  }
};

using Affine = AffineT<float>;
using Affined = AffineT<double>;

inline Affined translation(Vec3d by) { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, by}; }
inline Affined scaling(Vec3d by) { return {{{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}}, {}}; }

/// First `inner`, then `outer`.
inline Affined operator*(const Affined& outer, const Affined& inner) {
  Affined m;
  for (int i = 0; i < 3; ++i)
    m.row[i] = {dot(outer.row[i], inner.axis(0)), dot(outer.row[i], inner.axis(1)), dot(outer.row[i], inner.axis(2))};
  m.offset = outer.point(inner.offset);
  return m;
}

/// Rotation about the x, then the y, then the z axis, in degrees.
inline Affined rotation_deg(Vec3d angles) {
  Affined m;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = angles[axis] * (3.14159265358979323846 / 180), c = std::cos(a), s = std::sin(a);
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Affined turn;
    turn.row[u][u] = c, turn.row[u][v] = -s;
    turn.row[v][u] = s, turn.row[v][v] = c;
    m = turn * m;
  }
  return m;
}

/// Nothing when the map is singular or not finite.
inline std::optional<Affined> inverse(const Affined& m) {
  const double det = m.determinant();
  if (!(std::isfinite(det) && det != 0)) return std::nullopt;
  const Vec3d c0 = cross(m.row[1], m.row[2]) / det, c1 = cross(m.row[2], m.row[0]) / det,
              c2 = cross(m.row[0], m.row[1]) / det;
  Affined inv;
  for (int i = 0; i < 3; ++i) inv.row[i] = {c0[i], c1[i], c2[i]};
  inv.offset = -inv.vector(m.offset);
  if (!is_finite(inv.row[0]) || !is_finite(inv.row[1]) || !is_finite(inv.row[2]) || !is_finite(inv.offset))
    return std::nullopt;
  return inv;
}

/// Smallest axis-aligned box round the image of `b`.
inline Bounds3 transform_bounds(const Affined& m, const Bounds3& b) {
  Bounds3 out;
  if (!b.empty())
    for (int i = 0; i < 8; ++i) out.add(m.point(b.corner(i)));
  return out;
}

}  // namespace brume
