#pragma once

#include "renderer/media/fbm_noise.h"
#include "renderer/media/shader.h"

namespace brume {

/// What a cloud looks like; lengths in the volume's own units, z up.
struct CloudSettings {
  Vec3 center{0, 0, 0};
  Vec3 size{1, 0.8f, 0.6f};  ///< half extents of the ellipsoid that the cloud is carved out of; > 0
  float coverage = 1;        ///< share of the ellipsoid's falloff that is left, in [0,1]: less is a smaller core
  float flat_bottom = 0.8f;  ///< share of the lower half's height that is taken away, in [0,1)
  float roughness = 1;       ///< depth of the carving, in parts of the falloff; >= 0
  float softness = 0.15f;    ///< part of the falloff over which the density rises from 0 to 1; > 0
  FbmSettings noise{.frequency = 1.6f, .octaves = 7, .lacunarity = 2.1f, .gain = 0.55f, .seed = 8, .billow = 1};
};

/// A cumulus cloud: an ellipsoid with a flattened lower half, out of which fractal noise carves lumps,
///
///   density = clamp((coverage - |q|^2 - roughness erosion(x)) / softness, 0, 1)
///   erosion = clamp((1 - fbm(x)) / 2, 0, 1)
///
/// where q is the point in units of the half extents, q_z below 0 stretched by 1 / (1 - flat_bottom). Noise that is
/// added to the implicit function of a simple shape before it is cut off: Perlin & Hoffert 1989, "Hypertexture". Noise
/// made of |n|, for the lumps of a cumulus between their creases: Wrenninge 2012, "Production Volume Rendering",
/// "pyroclastic". Erosion only takes away, so the density is exactly 0 where |q|^2 >= coverage, and no noise is
/// evaluated there.
class CloudShader final : public Shader {
 public:
  /// @param local_from_scene  invertible
  CloudShader(const Affined& local_from_scene, const CloudSettings& settings);

  /// finest_scale is half the wavelength of the highest octave, but not less than 1/100 of the ellipsoid's shortest
  /// diameter: octaves beyond that cost steps out of proportion to their small weight, and steps at random offsets
  /// still see them right on average.
  ShaderTraits traits() const override { return {.finest_scale = finest_scale_, .lookup_nanoseconds = 5}; }

  /// About 1.2 ns per octave and point with AVX-512, 2.7 with AVX2; 0.3 ns for points outside the ellipsoid that come
  /// in groups of 16.
  void density(const PointBatch& points, float* density) const override;

  float max_density(const Bounds3&) const override { return 1; }

  /// What the kernels need to know of the ellipsoid.
  struct Shape {
    Affine q_from_scene;  // before the stretch
    float bottom_stretch;
    float coverage, roughness, inv_softness;
  };

 private:
  FbmNoise noise_;
  Shape shape_;
  float finest_scale_;  // world units
};

}  // namespace brume
