#include "tests/support/statistics.h"

#include <cmath>
#include <limits>

namespace brume {

double normal_upper_quantile(double q) {
  // Bisection on the tail itself: erfc keeps its relative precision out to 38 standard deviations.
  double low = -38, high = 38;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > q ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double sidak_z(double family_error, int comparisons) {
  const double single = -std::expm1(std::log1p(-family_error) / comparisons);
  return normal_upper_quantile(0.5 * single);
}

double chi_square_upper_tail(double x, double dof) {
  if (!(x > 0)) return 1;
  const double a = 0.5 * dof, y = 0.5 * x;
  const double front = std::exp(a * std::log(y) - y - std::lgamma(a));
  if (y < a + 1) {
    // Lower incomplete gamma by its power series: y^a e^-y sum_k y^k / (a (a+1) ... (a+k)).
    double term = 1 / a, sum = term;
    for (int k = 1; k < 10000 && term > 1e-17 * sum; ++k) sum += term *= y / (a + k);
    return 1 - front * sum;
  }
  // Upper one by its continued fraction, evaluated backwards from far out: 1/(y+1-a - 1(1-a)/(y+3-a - 2(2-a)/(...))).
  double tail = 0;
  for (int k = 2000; k >= 1; --k) tail = k * (k - a) / (y + 2 * k + 1 - a - tail);
  return front / (y + 1 - a - tail);
}

double chi_square_p_value(std::span<const double> observed, std::span<const double> expected) {
  double statistic = 0, pooled_observed = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double o, double e) { statistic += (o - e) * (o - e) / e, ++cells; };
  for (std::size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] == 0 && observed[i] > 0) return 0;
    if (expected[i] >= 5) {
      add(observed[i], expected[i]);
    } else {
      pooled_observed += observed[i], pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= 1) add(pooled_observed, pooled_expected);
  return cells < 2 ? 1 : chi_square_upper_tail(statistic, cells - 1);
}

double RunningMean::standard_error() const {
  return count_ > 1 ? std::sqrt(variance() / static_cast<double>(count_)) : std::numeric_limits<double>::infinity();
}

double integrate(const std::function<double(double)>& f, double a, double b, int panels) {
  // Roots and weights of the Legendre polynomial of degree 5.
  const double inner = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3, outer = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
  const double inner_weight = (322 + 13 * std::sqrt(70.0)) / 900, outer_weight = (322 - 13 * std::sqrt(70.0)) / 900;
  const double half = 0.5 * (b - a) / panels;
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double middle = a + (2 * i + 1) * half;
    sum += 128.0 / 225 * f(middle) + inner_weight * (f(middle - inner * half) + f(middle + inner * half)) +
           outer_weight * (f(middle - outer * half) + f(middle + outer * half));
  }
  return sum * half;
}

double correlation(std::span<const double> a, std::span<const double> b) {
  RunningMean mean_a, mean_b;
  for (std::size_t i = 0; i < a.size(); ++i) mean_a.add(a[i]), mean_b.add(b[i]);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a.mean()) * (b[i] - mean_b.mean());
  return sum / (static_cast<double>(a.size() - 1) * std::sqrt(mean_a.variance() * mean_b.variance()));
}

}  // namespace brume
