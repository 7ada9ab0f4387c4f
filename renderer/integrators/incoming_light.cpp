#include "renderer/integrators/incoming_light.h"

namespace brume {

/// Share of the directions at x that are drawn by the scatterer.
template <int C> float LightTechnique<C>::chance_share(Vec3 x, float peak) const {
  return is_large(light_.solid_angle(x), peak) ? 0.5f : 0.0f;
}

/// Blackens what a surface keeps away.
template <int C> void LightTechnique<C>::hide(IncomingLight& in, Vec3 x) const {
  const auto& surfaces = context_.scene.surfaces;
  if (surfaces && !is_black(in.scattered) && surfaces->occluded({x, in.wi, {0, in.distance * kJustBefore}}))
    in.scattered = {};
}

/// @param share  of the directions that are drawn by the scatterer.  @param combined  weighed against those
template <int C>
template <Scatterer<C> S>
IncomingLight LightTechnique<C>::by_point(const LightPoint& point, Vec3 x, const S& scatterer, float share,
                                          bool combined) const {
  const IncidentLight incident = light_.incident(point, x);
  IncomingLight in{incident.wi, incident.distance, {}};
  if (is_black(incident.irradiance)) return in;
  in.scattered = to_color(scatterer.value(in.wi)) * incident.irradiance;
  if (share > 0 && incident.pdf_w > 0) {
    in.pdf_ratio = (1 - share) + share * scatterer.pdf_w(in.wi) / incident.pdf_w;
    if (combined) in.scattered *= 1 / in.pdf_ratio;
  }
  hide(in, x);
  return in;
}

template <int C>
template <Scatterer<C> S>
IncomingLight LightTechnique<C>::towards(const LightPoint& point, Vec3 x, const S& scatterer) const {
  return by_point(point, x, scatterer, chance_share(x, scatterer.peak()), false);
}

template <int C>
template <Scatterer<C> S>
IncomingLight LightTechnique<C>::draw(LightPoint& point, Vec3 x, const S& scatterer) const {
  const Sampler& sampler = context_.sampler;
  const auto by_chance = [&] {
    return scatterer.sample(sampler.u1(Decision::PhaseLobe, bounce_, index_),
                            sampler.u2(Decision::PhaseDirection, bounce_, index_));
  };
  if (point.kind == LightPoint::Kind::Environment) {
    const Vec3 wi = by_chance();
    const Color weight = to_color(scatterer.weight(wi));
    IncomingLight in{wi, std::numeric_limits<float>::infinity(), weight * light_.environment_radiance()};
    hide(in, x);
    return in;
  }
  const float share = chance_share(x, scatterer.peak());
  if (share == 0 || sampler.u1(Decision::LightByChance, bounce_, index_) >= share)
    return by_point(point, x, scatterer, share, true);
  const Vec3 wi = by_chance();
  const auto hit = light_.hit({x, wi});
  if (!hit || !(hit->pdf_w > 0)) return {wi, 0, {}};
  point = hit->point;
  const float pdf = (1 - share) * hit->pdf_w + share * scatterer.pdf_w(wi);
  IncomingLight in{wi, hit->t, to_color(scatterer.value(wi)) * hit->radiance / pdf, pdf / hit->pdf_w, true};
  hide(in, x);
  return in;
}

template class LightTechnique<1>;
template class LightTechnique<3>;
template IncomingLight LightTechnique<1>::draw(LightPoint&, Vec3, const PhaseMixture<1>&) const;
template IncomingLight LightTechnique<3>::draw(LightPoint&, Vec3, const PhaseMixture<3>&) const;
template IncomingLight LightTechnique<1>::draw(LightPoint&, Vec3, const DiffuseReflection<1>&) const;
template IncomingLight LightTechnique<3>::draw(LightPoint&, Vec3, const DiffuseReflection<3>&) const;
template IncomingLight LightTechnique<1>::towards(const LightPoint&, Vec3, const PhaseMixture<1>&) const;
template IncomingLight LightTechnique<3>::towards(const LightPoint&, Vec3, const PhaseMixture<3>&) const;

}  // namespace brume
