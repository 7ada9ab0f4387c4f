#include "renderer/phase/draine.h"

#include "renderer/sampling/warps.h"

namespace brume {

// Everything is computed for |g|; a negative g is the mirror image, which alpha c^2 does not notice. m = 1 - c is small
// where the peak is, so it is m that is kept, and 1 + g^2 - 2 g c = (1 - g)^2 + 2 g m.

Draine::Draine(double g, double alpha) : g_(std::clamp(g, -0.9999, 0.9999)), alpha_(alpha) {
  scale_ = (1 - g_ * g_) / (2 * (1 + alpha_ * (1 + 2 * g_ * g_) / 3));
}

float Draine::value(float cos_theta) const {
  const double c = std::clamp(cos_theta, -1.0f, 1.0f), g = std::abs(g_);
  const double d = (1 - g) * (1 - g) + 2 * g * (1 - (g_ < 0 ? -c : c));
  return static_cast<float>(scale_ / (2 * 3.14159265358979323846) * (1 + alpha_ * c * c) / (d * std::sqrt(d)));
}

/// Share of the light that goes into cosines above 1 - m (for g >= 0). The integrals of m^k ((1-g)^2 + 2 g m)^(-3/2),
/// k = 0, 1, 2, from 0 to m, each written without differences and without a division by g: with r0 = 1 - g and
/// r^2 = r0^2 + 2 g m,
///   I0 = 2 m / ((r + r0) r r0),   I1 = 2 m^2 / ((r + r0)^2 r),   I2 = 2/3 m^3 (r + 3 r0) / ((r + r0)^3 r).
double Draine::forward_share(double m) const {
  const double g = std::abs(g_), r0 = 1 - g, r = std::sqrt(r0 * r0 + 2 * g * m), q = m / (r + r0);
  const double i0 = 2 * q / (r * r0), i1 = 2 * q * q / r, i2 = 2.0 / 3 * q * q * q * (r + 3 * r0) / r;
  return scale_ * ((1 + alpha_) * i0 - 2 * alpha_ * i1 + alpha_ * i2);
}

PhaseSample Draine::sample(Vec3 direction, Vec2 u) const {
  // Newton's method from the inverse of Henyey-Greenstein, kept inside a bracket. The inverse has a closed form, the
  // root of a quartic, but that cancels near g = 0 and |g| = 1.
  const double g = std::abs(g_), xi = u.x;
  double low = 0, high = 2;
  const double d = (1 - g) + 2 * g * (1 - xi);
  double m = std::min(2.0, (1 - g) * (1 - g) * xi * (2 + 2 * g * (1 - xi)) / (d * d));
  for (int i = 0; i < 60; ++i) {
    const double error = forward_share(m) - xi;
    (error > 0 ? high : low) = m;
    const double s = (1 - g) * (1 - g) + 2 * g * m;
    double next = m - error * s * std::sqrt(s) / (scale_ * (1 + alpha_ * (1 - m) * (1 - m)));
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double change = std::abs(next - m);
    m = next;
    if (change <= 1e-7 * m) break;  // the result is rounded to float
  }
  const float one_minus_cos = static_cast<float>(m);
  return {direction_about(g_ < 0 ? -direction : direction, one_minus_cos, u.y),
          value(g_ < 0 ? one_minus_cos - 1 : 1 - one_minus_cos)};
}

float Draine::mean_cosine() const {
  // The first and third moments of Henyey-Greenstein are g and g (3 + 2 g^2) / 5, the second is (1 + 2 g^2) / 3.
  return static_cast<float>(g_ * (1 + alpha_ * (3 + 2 * g_ * g_) / 5) / (1 + alpha_ * (1 + 2 * g_ * g_) / 3));
}

}  // namespace brume
