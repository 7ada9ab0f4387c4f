#include "renderer/phase/isotropic.h"

#include <algorithm>

#include "renderer/sampling/warps.h"

namespace brume {

float Isotropic::value(float) const { return kInv4Pi; }

void Isotropic::values(const float*, int n, float* out) const { std::fill_n(out, n, kInv4Pi); }

PhaseSample Isotropic::sample(Vec3, Vec2 u) const { return {uniform_sphere(u), uniform_sphere_pdf()}; }

}  // namespace brume
