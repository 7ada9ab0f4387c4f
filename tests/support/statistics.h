// What tests of random things need: tails of distributions, running means, quadrature.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace brume {

/// The x that a standard normal variable exceeds with probability q, q in (0, 1).
double normal_upper_quantile(double q);

/// Bound on |z| for each of `comparisons` two-sided normal tests such that all of them pass with probability
/// 1 - family_error when every tested value is right. Sidak 1967, "Rectangular confidence regions for the means of
/// multivariate normal distributions": every single test gets the error 1 - (1 - family_error)^(1/m).
double sidak_z(double family_error, int comparisons);

/// Probability that a chi-square variable of `dof` degrees of freedom exceeds x.
double chi_square_upper_tail(double x, double dof);

/// Significance below which a chi-square test of this suite fails: with fixed seeds it is a rare accident of a changed
/// random stream (one in ten thousand), and a wrong sampler gives 1e-10 and less.
inline constexpr double kChiSquareSignificance = 1e-4;

/// p-value of Pearson's chi-square test. Cells that expect fewer than 5 are pooled, as the chi-square distribution is
/// only the limit for large cells; a cell that expects exactly nothing must be empty, else the result is 0.
/// @param expected  in counts; its sum should be that of `observed`
double chi_square_p_value(std::span<const double> observed, std::span<const double> expected);

/// Mean and variance of a stream. Welford 1962, equations 1 and 2.
class RunningMean {
 public:
  void add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / static_cast<double>(count_);
    m2_ += delta * (x - mean_);
  }
  std::uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  double variance() const { return count_ > 1 ? m2_ / static_cast<double>(count_ - 1) : 0; }
  double standard_error() const;  ///< of the mean

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0, m2_ = 0;
};

/// Integral of f over [a, b]: Gauss-Legendre of 5 points on each of `panels` equal parts (exact for degree 9).
double integrate(const std::function<double(double)>& f, double a, double b, int panels);

/// Pearson's correlation of two samples of equal size.
double correlation(std::span<const double> a, std::span<const double> b);

}  // namespace brume
