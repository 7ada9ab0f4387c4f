// The weights of product sampling, at SIMD width.
#pragma once

namespace brume {

/// A light as a ray sees it. Lengths in world units, along the ray from its origin.
struct ProductTerms {
  float foot;      ///< of the light on the ray
  float off_ray;   ///< distance of the light from the ray
  float distance;  ///< the same, but at least the light's radius: 1/(distance^2 + s^2) stays bounded
  float height;    ///< of the ray's origin above the light's plane
  float slope;     ///< by which it grows along the ray
  bool two_sided;  ///< lit below the plane too
  bool flat;       ///< has a plane at all
};

/// cosine[i] between the ray's direction and that of light that comes from the pivot to edge i, for i in [0, n].
/// @param t  [n + 1], readable for another vector behind the end; arrays are those of an Arena
void light_cosines(const float* t, int n, const ProductTerms& terms, float* cosine);

/// weight[i] = p[i] / (distance^2 + s^2) * (phase[i] + phase[i + 1]) / 2 * (cosine at the light), s and the cosine
/// those of the middle of segment i; where the plane cuts the segment the cosine is not 0 while some of it is lit. The
/// phase function is that of the edges because a sharp peak may lie between the middles.
/// @param p  [n].  @param phase  [n + 1], may be null
/// @param angle  [n], becomes (length of segment i) / (distance^2 + s^2), and 0 where p is
void product_weights(const float* t, const float* p, const float* phase, int n, const ProductTerms& terms,
                     float* weight, float* angle);

}  // namespace brume
