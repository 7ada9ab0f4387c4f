#include "tests/support/reference_medium.h"

#include <algorithm>
#include <cmath>

namespace brume {

double reference_density(const ReferenceCase& c, Vec3d x) {
  const ReferenceKind& d = c.density;
  if (d.type == "constant") return 1;
  if (d.type == "exponential")
    return std::exp(-(x[static_cast<int>(real(d, "axis"))] - real(d, "y0")) / real(d, "scale_height"));
  if (d.type == "gaussian")
    return std::exp(-length_squared(x - vec(d, "center")) / (2 * real(d, "sigma") * real(d, "sigma")));
  if (d.type == "linear") return real(d, "offset") + dot(vec(d, "gradient"), x);
  if (d.type == "slabs") {
    const auto& edges = d.numbers.at("edges");
    const double at = x[static_cast<int>(real(d, "axis"))];
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
      if (at >= edges[i] && at < edges[i + 1]) return d.numbers.at("values")[i];
    return 0;
  }
  if (d.type == "shell") {
    const double r = length(x - vec(d, "center"));
    return r >= real(d, "r_inner") && r <= real(d, "r_outer") ? 1 : 0;
  }
  if (d.type == "sinusoid")
    return 1 + real(d, "amplitude") *
                   std::sin(2 * 3.14159265358979323846 * dot(vec(d, "wavevector"), x) + real(d, "phase"));
  return std::nan("");
}

namespace {

/// @param grow  added to the bounds on all sides
ReferenceSpan span_of(const ReferenceCase& c, const ReferenceRay& ray, double grow) {
  ReferenceSpan span{ray.tmin, ray.tmax};
  if (c.bounds.type == "sphere") {
    const Vec3d to_center = vec(c.bounds, "center") - ray.origin;
    const double middle = dot(to_center, ray.direction), radius = real(c.bounds, "radius") + grow;
    const double rest = radius * radius - length_squared(to_center - ray.direction * middle);
    if (rest <= 0) return {0, 0};
    return {std::max(span.begin, middle - std::sqrt(rest)), std::min(span.end, middle + std::sqrt(rest))};
  }
  const Vec3d low = vec(c.bounds, "min") - Vec3d(grow), high = vec(c.bounds, "max") + Vec3d(grow);
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (o < low[axis] || o > high[axis]) return {0, 0};
      continue;
    }
    const double a = (low[axis] - o) / d, b = (high[axis] - o) / d;
    span.begin = std::max(span.begin, std::min(a, b));
    span.end = std::min(span.end, std::max(a, b));
  }
  return span;
}

/// Half a unit in the last place of a float near v.
double half_ulp(double v) { return std::abs(v) * 0x1p-24; }

}  // namespace

ReferenceSpan reference_span(const ReferenceCase& c, const ReferenceRay& ray) { return span_of(c, ray, 0); }

double density_variation(const ReferenceCase& c, const ReferenceRay& ray) {
  const ReferenceSpan span = reference_span(c, ray);
  if (!c.heterogeneous() || span.length() == 0) return 0;
  constexpr int kPoints = 100000;  // far finer than any profile of the data: 64 cycles per unit over 2 units
  double sum = 0, last = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = span.begin + (i + 0.5) / kPoints * span.length();
    const double density = reference_density(c, ray.origin + ray.direction * t);
    if (i > 0) sum += std::abs(density - last);
    last = density;
  }
  return sum;
}

double column_rounding(const ReferenceCase& c, const ReferenceRay& ray) {
  const ReferenceSpan span = reference_span(c, ray);
  double size = 1e-30;  // of the coordinates that the medium is known by
  for (const auto& [key, value] : c.bounds.numbers)
    for (const double v : value) size = std::max(size, std::abs(v));

  // Length of the span: one rounded coordinate of the ray after the other, and the bounds.
  double length_error = 2 * half_ulp(span.end);  // its ends are floats
  for (int axis = 0; axis < 3; ++axis) {
    ReferenceRay moved = ray;
    moved.origin[axis] += half_ulp(ray.origin[axis]);
    length_error += std::abs(reference_span(c, moved).length() - span.length());
    moved = ray;
    moved.direction[axis] += half_ulp(ray.direction[axis]);
    length_error += std::abs(reference_span(c, moved).length() - span.length());
  }
  length_error += std::abs(span_of(c, ray, half_ulp(size)).length() - span.length());

  // A displacement of every look-up by e changes the integral by at most e times the variation of the density.
  double peak = 0;
  for (const double t : {span.begin, span.end})
    peak = std::max(peak, reference_density(c, ray.origin + ray.direction * t));
  const double displacement = 2 * half_ulp(span.end) + 2 * half_ulp(size);
  return length_error * (c.heterogeneous() ? peak : 1.0) + displacement * density_variation(c, ray);
}

}  // namespace brume
