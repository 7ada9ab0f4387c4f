// What both kinds of vertices of a path have in common: a point of a medium and a point of a surface.
#pragma once

#include <concepts>

#include "renderer/core/spectrum.h"
#include "renderer/sampling/warps.h"

namespace brume {

/// Scatters light of a given ray. `value` is what it turns from wi towards the ray's origin, per sr: the phase function
/// (sigma_s is left to the caller), or the BRDF with its cosine.
template <class S, int C>
concept Scatterer = requires(const S& s, Vec3 wi, float u_lobe, Vec2 u) {
  { s.value(wi) } -> std::same_as<Spectrum<C>>;
  { s.pdf_w(wi) } -> std::same_as<float>;         // with which sample() draws wi, per sr
  { s.weight(wi) } -> std::same_as<Spectrum<C>>;  // value over pdf_w, for a direction that sample() has drawn
  { s.sample(u_lobe, u) } -> std::same_as<Vec3>;  // unit
  { s.peak() } -> std::same_as<float>;            // upper bound of pdf_w
};

/// Lambert's law: albedo / pi times the cosine.
template <int C> class DiffuseReflection {
 public:
  /// @param normal  unit, on the side that is lit
  DiffuseReflection(Vec3 normal, Color albedo) : normal_(normal), albedo_(from_color<C>(albedo)) {}

  Spectrum<C> value(Vec3 wi) const {
    Spectrum<C> v = albedo_;
    for (float& c : v.v) c *= pdf_w(wi);
    return v;
  }
  float pdf_w(Vec3 wi) const { return std::max(0.0f, dot(normal_, wi)) / kPi; }
  Spectrum<C> weight(Vec3) const { return albedo_; }
  Vec3 sample(float, Vec2 u) const { return cosine_hemisphere(normal_, u); }
  float peak() const { return 1 / kPi; }

 private:
  Vec3 normal_;
  Spectrum<C> albedo_;
};

}  // namespace brume
