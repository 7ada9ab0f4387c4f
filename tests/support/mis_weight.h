// Multiple importance sampling, one sample at a time: what carry() is held against.
#pragma once

#include <algorithm>

#include "renderer/scene/settings.h"

namespace brume {

/// Weight of a sample drawn with density pdf when another technique, with as many samples, could have drawn it with
/// density other_pdf. Veach & Guibas 1995, "Optimally Combining Sampling Techniques", equations 14 and 16 (exponent 2).
/// Divided through by the larger pdf, so that no square overflows.
inline float mis_weight(MisHeuristic heuristic, float pdf, float other_pdf) {
  if (!(pdf > 0)) return 0;
  // Which of the two is larger is anyone's guess, a processor's, too: no branch on it.
  const float r = std::min(pdf, other_pdf) / std::max(pdf, other_pdf);
  const float smaller = heuristic == MisHeuristic::Power ? r * r : r;
  return (pdf >= other_pdf ? 1 : smaller) / (1 + smaller);
}

}  // namespace brume
