// Media and records of a ray, made without a scene description.
#pragma once

#include <memory>
#include <vector>

#include "renderer/march/distribute.h"
#include "renderer/media/constant_shader.h"
#include "renderer/media/profile_shader.h"

namespace brume {

inline Medium medium_of(std::shared_ptr<const Shader> shader, std::shared_ptr<const Shape> shape, Color sigma_s,
                        Color sigma_t, Color emission = {}) {
  Medium m;
  m.traits = shader->traits();
  m.shader = std::move(shader);
  m.shape = std::move(shape);
  m.sigma_s = sigma_s;
  m.sigma_t = sigma_t;
  m.emission = emission;
  return m;
}

/// Homogeneous, in an axis-aligned box.
inline Medium homogeneous_box(Vec3d low, Vec3d high, Color sigma_s, Color sigma_t, Color emission = {}) {
  return medium_of(std::make_shared<ConstantShader>(), std::make_shared<BoxShape>(low, high), sigma_s, sigma_t,
                   emission);
}

/// A density of the z coordinate, in a box; marched.
inline Medium profile_box(std::function<float(float)> density_of_z, Vec3d low, Vec3d high, Color sigma_s, Color sigma_t,
                          Color emission = {}) {
  return medium_of(std::make_shared<ProfileShader>(
                       Affine{}, 0.1f,
                       ProfileShader::Profile{[f = std::move(density_of_z)](Vec3 p) { return f(p.z); },
                                              [](const Bounds3&) { return std::numeric_limits<double>::infinity(); }}),
                   std::make_shared<BoxShape>(low, high), sigma_s, sigma_t, emission);
}

/// A ray up the z axis from (0, 0, z).
inline Ray ray_along_z(float z = 0, Interval span = {0, std::numeric_limits<float>::infinity()}) {
  return {{0, 0, z}, {0, 0, 1}, span};
}

/// A record that is ready to be sampled, with the arena that holds it.
template <int C> class RecordedRay {
 public:
  RecordedRay(std::vector<Medium> media, const Ray& ray, float step, float offset = 0.5f, Color throughput = Color(1))
      : media_(std::move(media)), scope_(arena_) {
    const bool emits = std::any_of(media_.begin(), media_.end(), [](const Medium& m) { return m.emits(); });
    record_ = record<C>(media_, {emits, media_.size() > 1}, ray, {step, offset, 0}, arena_, counts_);
    if (!record_.empty()) distribute(record_, throughput, arena_);
  }
  const MarchRecord<C>& operator*() const { return record_; }
  const MarchRecord<C>* operator->() const { return &record_; }
  const MarchCounts& counts() const { return counts_; }

 private:
  std::vector<Medium> media_;
  Arena arena_;
  ArenaScope scope_;
  MarchCounts counts_;
  MarchRecord<C> record_;
};

}  // namespace brume
