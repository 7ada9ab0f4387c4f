// Rendered values held against their references.
#pragma once

#include "tests/support/reference_probe.h"

namespace brume {

/// By how much a mean may differ from the expected value, and why; absolute values.
struct ReferenceTolerance {
  double statistical = 0;  ///< z times the standard error
  double floating = 0;     ///< float arithmetic
  double reference = 0;    ///< the reference's own error
  double bias = 0;         ///< stated bias of the method at the step used
  double total() const { return statistical + floating + reference + bias; }
};

/// One number held against its reference.
struct CaseResult {
  std::string id, quantity, mode;
  int channel = 0;
  double expected = 0, mean = 0, standard_error = 0;
  double z = 0;  ///< what the allowances other than noise leave of the difference, in standard errors
  ReferenceTolerance tolerance;
  std::uint64_t samples = 0, non_finite = 0;
  bool passed = false;

  std::string to_string() const;  ///< one line
};

/// Judges one channel. Passes when the difference is within the tolerance, and every sample was finite.
/// @param allowed_z  standard errors granted.  @param floating, bias  absolute
CaseResult judge(const ReferenceCase& c, const ReferenceQuantity& quantity, const std::string& mode, int channel,
                 const ReferenceEstimate& estimate, double allowed_z, double floating, double bias);

}  // namespace brume
