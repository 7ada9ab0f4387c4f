// The medium of a reference case, evaluated in double by formulas of its own, for bounds on errors.
#pragma once

#include "tests/support/reference_case.h"

namespace brume {

double reference_density(const ReferenceCase& c, Vec3d x);

/// The part of the line inside the bounds and the ray's range; begin >= end where there is none.
struct ReferenceSpan {
  double begin = 0, end = 0;
  double length() const { return end > begin ? end - begin : 0; }
};
ReferenceSpan reference_span(const ReferenceCase& c, const ReferenceRay& ray);

/// Sum of |changes| of the density along the ray inside the bounds; without the jumps at its ends.
double density_variation(const ReferenceCase& c, const ReferenceRay& ray);

/// How far float arithmetic can move the column density of this ray: half a unit in the last place of every coordinate
/// of the ray and of the bounds, and of the positions along the ray at which the density is looked up.
double column_rounding(const ReferenceCase& c, const ReferenceRay& ray);

}  // namespace brume
