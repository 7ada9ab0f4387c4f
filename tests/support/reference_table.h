// Outcomes of a reference run, as text, as JSON and as the README's table.
#pragma once

#include "tests/support/reference_run.h"

namespace brume {

/// One line per comparison.
std::string format_outcomes(const std::vector<ReferenceOutcome>& outcomes);

/// Per method: cases, comparisons, failures, expected failures, largest deviation.
std::string format_summary(const std::vector<ReferenceOutcome>& outcomes);

/// Markdown: one row per method, one column per file, each with the largest deviation in standard errors beyond the
/// other allowances.
std::string format_table(const std::vector<ReferenceOutcome>& outcomes);

std::string format_json(const std::vector<ReferenceOutcome>& outcomes);

}  // namespace brume
