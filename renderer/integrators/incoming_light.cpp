#include "renderer/integrators/incoming_light.h"

namespace brume {

/// Share of the directions at x that are drawn by the phase function.
template <int C> float LightTechnique<C>::chance_share(Vec3 x) const {
  return light_.solid_angle(x) * context_.scene.phase_peak > 1 ? 0.5f : 0.0f;
}

template <int C>
IncomingLight LightTechnique<C>::towards(const LightPoint& point, Vec3 x, Vec3 direction,
                                         const PhaseMixture<C>& phase) const {
  const IncidentLight incident = light_.incident(point, x);
  IncomingLight in{incident.wi, incident.distance, {}, point};
  if (is_black(incident.irradiance)) return in;
  const float cos_theta = dot(direction, incident.wi);
  in.scattered = to_color(phase.value(cos_theta)) * incident.irradiance;
  const float share = chance_share(x);
  if (share > 0 && incident.pdf_w > 0) in.pdf_ratio = (1 - share) + share * phase.pdf_w(cos_theta) / incident.pdf_w;
  return in;
}

template <int C>
IncomingLight LightTechnique<C>::draw(const LightPoint& point, Vec3 x, Vec3 direction,
                                      const PhaseMixture<C>& phase) const {
  const Sampler& sampler = context_.sampler;
  const auto by_phase = [&] {
    return phase.sample(direction, sampler.u1(Decision::PhaseLobe, bounce_, index_),
                        sampler.u2(Decision::PhaseDirection, bounce_, index_));
  };
  if (point.kind == LightPoint::Kind::Environment) {
    const Vec3 wi = by_phase();
    const Color weight = to_color(phase.weight(dot(direction, wi)));
    return {wi, std::numeric_limits<float>::infinity(), weight * light_.environment_radiance(), point};
  }
  const float share = chance_share(x);
  if (share == 0 || sampler.u1(Decision::LightByChance, bounce_, index_) >= share) {
    IncomingLight in = towards(point, x, direction, phase);
    in.scattered *= 1 / in.pdf_ratio;
    return in;
  }
  const Vec3 wi = by_phase();
  const auto hit = light_.hit({x, wi});
  if (!hit || !(hit->pdf_w > 0)) return {wi, 0, {}, {}};
  const float cos_theta = dot(direction, wi);
  const float pdf = (1 - share) * hit->pdf_w + share * phase.pdf_w(cos_theta);
  return {wi, hit->t, to_color(phase.value(cos_theta)) * hit->radiance / pdf, hit->point, pdf / hit->pdf_w};
}

template class LightTechnique<1>;
template class LightTechnique<3>;

}  // namespace brume
