#include "renderer/integrators/scatter_direction.h"

#include "renderer/sampling/warps.h"

namespace brume {
namespace {

/// pdf of a direction at the angle alpha from `axis` when alpha and the azimuth are uniform, per sr.
float uniform_angle_pdf(Vec3 axis, Vec3 direction) {
  const float sin_alpha = length(cross(axis, direction));
  return 1 / (2 * kPi * kPi * std::max(sin_alpha, 1e-12f));
}

}  // namespace

template <int C, Scatterer<C> S>
ScatteredDirection<C> scatter_direction(const S& scatterer, Vec3 x, int bounce, const SampleContext& context) {
  const Sampler& sampler = context.sampler;
  const auto& lamps = context.scene.lamps_inside;
  const Vec2 u = sampler.u2(Decision::BounceDirection, bounce);
  const int count = static_cast<int>(lamps.size());

  // The lamp's direction is drawn, the others' are only needed for the pdf.
  Vec3 axes[Scene::kMaxLampsInside];
  for (int l = 0; l < count; ++l) {
    const LightPoint point =
        lamps[static_cast<std::size_t>(l)]->sample_point(sampler.u2(Decision::BounceLampPoint, bounce, l));
    const Vec3 to_lamp = point.position - x;
    const float distance = length(to_lamp);
    axes[l] = distance > 0 ? to_lamp / distance : Vec3(0, 0, 1);
  }
  ScatteredDirection<C> out;
  const float choice = count > 0 ? 2 * sampler.u1(Decision::BounceTechnique, bounce) : 2;
  if (choice < 1) {
    const int l = std::min(static_cast<int>(choice * static_cast<float>(count)), count - 1);
    const float s = std::sin(0.5f * kPi * u.x);  // alpha = pi u, 1 - cos(alpha) = 2 sin^2(alpha / 2)
    out.direction = direction_about(axes[l], 2 * s * s, u.y);
  } else {
    out.direction = scatterer.sample(sampler.u1(Decision::BounceLobe, bounce), u);
  }

  if (count == 0) {
    out.weight = scatterer.weight(out.direction);
    return out;
  }
  float about_lamps = 0;
  for (int l = 0; l < count; ++l) about_lamps += uniform_angle_pdf(axes[l], out.direction);
  const float pdf = 0.5f * (scatterer.pdf_w(out.direction) + about_lamps / static_cast<float>(count));
  out.weight = scatterer.value(out.direction);
  for (float& v : out.weight.v) v = pdf > 0 ? v / pdf : 0;
  return out;
}

template ScatteredDirection<1> scatter_direction(const PhaseMixture<1>&, Vec3, int, const SampleContext&);
template ScatteredDirection<3> scatter_direction(const PhaseMixture<3>&, Vec3, int, const SampleContext&);
template ScatteredDirection<1> scatter_direction(const DiffuseReflection<1>&, Vec3, int, const SampleContext&);
template ScatteredDirection<3> scatter_direction(const DiffuseReflection<3>&, Vec3, int, const SampleContext&);

}  // namespace brume
