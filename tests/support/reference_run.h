// Reference cases rendered by several methods and judged: what the tests assert and what brume-reference prints.
//
// Every comparison is planned before any is made, because the number of standard errors that each is granted follows
// from how many there are: right values fail a whole run once in a thousand times (Sidak). A comparison that fails is
// repeated with 16 times the samples and another seed; both are reported, and the second decides.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/reference_judge.h"

namespace brume {

/// An integrator, and for the decoupled one a distance sampling.
struct ReferenceMethod {
  std::string integrator;
  DistanceSampling mode = DistanceSampling::Mis;

  std::string name() const;  ///< "null_scattering", "decoupled density"
  bool tracks() const;       ///< no march, no step, no bias
};

/// null_scattering, and decoupled in its three modes.
std::vector<ReferenceMethod> default_reference_methods();

/// "decoupled" is its three modes, "decoupled:mis" one of them, any other key one method.
Result<std::vector<ReferenceMethod>> reference_methods(const std::string& key);

struct ReferenceOptions {
  std::vector<ReferenceMethod> methods = default_reference_methods();
  double relative_error = 3e-3;          ///< aim for the standard error
  double seconds = 0.25;                 ///< CPU time that a comparison may take; fewer samples then, and more noise
  std::optional<std::uint64_t> samples;  ///< instead of both
  std::string tag;                       ///< only cases with this tag; empty: all
  bool everything = false;               ///< every quantity of every case; else a choice that differs from case to case
};

/// A quantity of a case by one method: up to three comparisons, one per channel that differs.
struct ReferenceOutcome {
  std::string file, id, method;
  std::vector<CaseResult> first, second;  ///< of the repetition, where there was one
  double noise = 0;                       ///< largest standard error over the expected value
  double relative_deviation = 0;          ///< of a single sample
  std::string expected_failure;           ///< why this method cannot do it, by its nature; empty otherwise
  std::string unsupported;                ///< why Brume cannot express the case

  const std::vector<CaseResult>& last() const { return second.empty() ? first : second; }
  bool passed() const;
};

/// Plans and runs the comparisons of all files, on all hardware threads; outcomes come in the order of the plan.
/// @param only  the case of this id; empty: all
/// @param progress  called with what is done and how many there are
Result<std::vector<ReferenceOutcome>> run_references(const std::vector<std::string>& files, const std::string& only,
                                                     const ReferenceOptions& options,
                                                     const std::function<void(int, int)>& progress = {});

/// What a method cannot do by its nature, with the reason; empty where it can. These are rendered all the same.
std::string reference_expected_failure(const ReferenceCase& c, const ReferenceQuantity& q,
                                       const ReferenceMethod& method);

}  // namespace brume
