// Densities with a formula: layered fog, soft balls, and the profiles whose light is known in closed form.
#pragma once

#include <functional>
#include <vector>

#include "renderer/media/shader.h"

namespace brume {

/// A density given by a function of a point in the volume's own space. For test scenes and simple fogs: the function is
/// called point by point, so it runs at scalar speed.
class ProfileShader final : public Shader {
 public:
  struct Profile {
    std::function<float(Vec3)> density;
    std::function<double(const Bounds3&)> bound;  ///< upper bound inside a box
  };

  /// @param profile  dimensionless density >= 0.  @param finest_scale  world units, sets the automatic step
  ProfileShader(const Affine& local_from_scene, float finest_scale, Profile profile)
      : local_from_scene_(local_from_scene), finest_scale_(finest_scale), profile_(std::move(profile)) {}

  ShaderTraits traits() const override {
    return {.constant = false, .own_emission = false, .finest_scale = finest_scale_, .lookup_nanoseconds = 5};
  }
  void density(const PointBatch& points, float* density) const override;
  float max_density(const Bounds3& box) const override;

 private:
  Affine local_from_scene_;
  float finest_scale_;
  Profile profile_;
};

// The profiles, with the parameters of their tables (profile_registry.cpp).
ProfileShader::Profile exponential_profile(int axis, float y0, float scale_height);
ProfileShader::Profile gaussian_profile(Vec3 center, float sigma);
ProfileShader::Profile linear_profile(Vec3 gradient, float offset);
/// values[i] where edges[i] <= x[axis] < edges[i + 1], 0 elsewhere; edges ascend, one more than values.
ProfileShader::Profile slabs_profile(int axis, std::vector<float> edges, std::vector<float> values);
/// 1 where inner <= |x - center| <= outer.
ProfileShader::Profile shell_profile(Vec3 center, float inner, float outer);
/// 1 + amplitude sin(2 pi dot(wavevector, x) + phase); |amplitude| <= 1.
ProfileShader::Profile sinusoid_profile(float amplitude, Vec3 wavevector, float phase);

}  // namespace brume
