#include "tests/support/reference_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace brume {

std::string CaseResult::to_string() const {
  char text[512];
  std::snprintf(text, sizeof text,
                "%-34s %-24s %-12s %c  expected %.7g  mean %.7g +- %.2g (%.3f %%)  z %+.2f  allowed %.3g = %.3g noise "
                "+ %.3g float + %.3g "
                "reference + %.3g bias  %llu samples%s%s",
                id.c_str(), quantity.c_str(), mode.c_str(), "RGB"[channel], expected, mean, standard_error,
                expected != 0 ? 100 * standard_error / std::abs(expected) : 0.0, z, tolerance.total(),
                tolerance.statistical, tolerance.floating, tolerance.reference, tolerance.bias,
                static_cast<unsigned long long>(samples), non_finite ? "  NOT FINITE: " : "",
                non_finite ? std::to_string(non_finite).c_str() : "");
  return text;
}

CaseResult judge(const ReferenceCase& c, const ReferenceQuantity& quantity, const std::string& mode, int channel,
                 const ReferenceEstimate& estimate, double allowed_z, double floating, double bias) {
  const auto k = static_cast<std::size_t>(channel);
  CaseResult r;
  r.id = c.id;
  r.quantity = quantity.name;
  r.mode = mode;
  r.channel = channel;
  r.expected = quantity.expected[k];
  r.mean = estimate.mean[k];
  r.samples = estimate.samples;
  r.non_finite = estimate.non_finite;
  // The noise of a reference made by Monte Carlo adds to ours.
  r.standard_error = std::hypot(estimate.standard_error[k], quantity.reference_deviation);
  r.tolerance = {allowed_z * r.standard_error, floating, quantity.reference_error * std::abs(r.expected), bias};
  const double difference = r.mean - r.expected;
  const double excess = std::max(0.0, std::abs(difference) - (r.tolerance.total() - r.tolerance.statistical));
  r.z = excess == 0 ? 0 : std::copysign(r.standard_error > 0 ? excess / r.standard_error : 1e9, difference);
  r.passed = std::abs(difference) <= r.tolerance.total() && estimate.non_finite == 0;
  return r;
}

}  // namespace brume
