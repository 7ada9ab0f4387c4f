// Multiple importance sampling.
#pragma once

#include "renderer/scene/settings.h"

namespace brume {

/// Weight of a sample drawn with density pdf when another technique, with as many samples, could have drawn it with
/// density other_pdf. Veach & Guibas 1995, "Optimally Combining Sampling Techniques", equations 14 and 16 (exponent 2).
/// Divided through by the larger pdf, so that no square overflows.
inline float mis_weight(MisHeuristic heuristic, float pdf, float other_pdf) {
  if (!(pdf > 0)) return 0;
  if (pdf >= other_pdf) {
    const float r = other_pdf / pdf;
    return 1 / (1 + (heuristic == MisHeuristic::Power ? r * r : r));
  }
  const float r = pdf / other_pdf;
  return heuristic == MisHeuristic::Power ? r * r / (1 + r * r) : r / (1 + r);
}

}  // namespace brume
