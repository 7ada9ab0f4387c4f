#include "renderer/integrators/null_scattering.h"

#include "renderer/integrators/path.h"
#include "renderer/integrators/registry.h"
#include "renderer/integrators/scatter_direction.h"
#include "renderer/integrators/track.h"
#include "renderer/march/equiangular_distribution.h"

namespace brume {
namespace {

/// Per channel c: the measurement contribution f of the path so far, and the pdf p with which tracking led by channel c
/// would have made it. Both lack the factors that all channels share.
template <int C> struct Path { Spectrum<C> f = filled<C>(1), p = filled<C>(1); };

template <int C> float mean_of(const Spectrum<C>& s) {
  float sum = 0;
  for (float v : s.v) sum += v;
  return sum / C;
}

template <int C> Spectrum<C> operator*(const Spectrum<C>& a, const Spectrum<C>& b) {
  Spectrum<C> r;
  for (int c = 0; c < C; ++c) r[c] = a[c] * b[c];
  return r;
}

/// One ray of a path: how it meets the lights, and where it goes on.
template <int C> struct Leg {
  const Ray& ray;
  const Path<C>& path;
  int bounce;
  SampleContext& context;

  /// Density of having come to a real collision after null collisions of product n, over that of their places.
  float tracked_pdf(const Spectrum<C>& n, const Spectrum<C>& sigma_t) const { return mean_of(path.p * n * sigma_t); }

  float equiangular_pdf(const Light& light, const LightPoint& point, float t, Interval inside) const {
    if (point.kind != LightPoint::Kind::Finite) return 0;
    const Interval lit = intersect(inside, light.lit_part(point, {ray.origin, ray.direction, inside}));
    return lit.empty() ? 0 : EquiangularDistribution(ray, point.position, lit).pdf(t);
  }

  /// Light samples at the real collision that tracking has come to.
  Color at_collision(const Collision<C>& at, const Spectrum<C>& n, Interval inside) const {
    const Vec3 x = ray.at(at.t);
    const PhaseMixture<C> phase(context.scene, ray.direction, at.densities);
    const float tracked = tracked_pdf(n, at.sigma_t);
    const Color value = to_color(path.f * n * at.sigma_s) / tracked;
    if (is_black(value)) return {};
    TrackedShadows<C> shadows(bounce, context);
    for_light_samples(bounce, 0, context.light_samples(), context,
                      [&](const Light& light, float factor, const LightNumbers& numbers, int k) {
                        LightPoint point = light.sample_point(numbers.point(k));
                        const IncomingLight in =
                            LightTechnique<C>(light, context, bounce, numbers.index(k)).draw(point, x, phase);
                        if (is_black(in.scattered)) return;
                        const float mine = tracked * in.pdf_ratio;
                        const float other = mean_of(path.p) * equiangular_pdf(light, point, at.t, inside);
                        const Color carried = value * in.scattered * (factor * mine / (mine + other));
                        context.note(bounce, x, DistanceTechnique::Density, carried);
                        shadows.add(light, {x, in.wi, {0, in.distance}}, carried, numbers.of_shadow(k));
                      });
    return shadows.light();
  }

  /// Light samples at distances drawn about the light points; the null collisions up to there are those of ratio
  /// tracking, drawn with the density that tracking draws them with.
  Color about_lights(Interval inside) const {
    TrackedShadows<C> shadows(bounce, context);
    for_light_samples(
        bounce, 1, context.light_samples(), context,
        [&](const Light& light, float factor, const LightNumbers& numbers, int k) {
          const LightPoint point = light.sample_point(numbers.point(k));
          if (point.kind != LightPoint::Kind::Finite) return;
          const Interval lit = intersect(inside, light.lit_part(point, {ray.origin, ray.direction, inside}));
          if (lit.empty()) return;
          const ArenaScope scope(context.arena);
          const DistanceSample drawn =
              EquiangularDistribution(ray, point.position, lit)
                  .sample(numbers.distances(Decision::EquiangularDistance)(k, numbers.count()));
          if (!(drawn.pdf_t > 0)) return;
          const Collision<C> at = collision_at<C>(context.scene.media, ray, drawn.t, context.scene.render.time,
                                                  context.arena, context.statistics.march);
          const Vec3 x = ray.at(drawn.t);
          const PhaseMixture<C> phase(context.scene, ray.direction, at.densities);
          if (mean_of(at.sigma_s) == 0) return;
          const IncomingLight in = LightTechnique<C>(light, context, bounce, numbers.index(k)).towards(point, x, phase);
          if (is_black(in.scattered)) return;
          const Spectrum<C> n =
              tracked_transmittance<C>({ray.origin, ray.direction, {ray.span.begin, drawn.t}},
                                       Decision::EquiangularFlight, bounce, numbers.index(k), context);
          const float mine = mean_of(path.p) * drawn.pdf_t;
          const float other = tracked_pdf(n, at.sigma_t) * in.pdf_ratio;
          const Color carried = to_color(path.f * n * at.sigma_s) * in.scattered * (factor / (mine + other));
          context.note(bounce, x, DistanceTechnique::Equiangular, carried);
          shadows.add(light, {x, in.wi, {0, in.distance}}, carried, numbers.of_shadow(k));
        });
    return shadows.light();
  }
};

template <int C> Color trace(Ray ray, SampleContext& context) {
  const Scene& scene = context.scene;
  const Sampler& sampler = context.sampler;
  std::optional<SurfaceHit> surface = close(ray, scene);
  if (context.diagnostics) diagnose_by_tracking<C>(ray, context);
  Color radiance = visible_lights(scene, ray, surface, [&](float t) { return transmittance_to<C>(ray, t, context); });
  const int leader = leading_channel<C>(sampler);
  Path<C> path;
  for (int bounce = 0;; ++bounce) {
    const ArenaScope scope(context.arena);
    ++context.statistics.rays;
    const Presence presence = find_presence(scene.media, ray, context.arena);
    const Interval inside = presence.empty() ? Interval{} : Interval{presence.edges.front(), presence.edges.back()};
    const Leg<C> leg{ray, path, bounce, context};

    auto collisions = track<C>(ray, Decision::Flight, bounce, 0, context);
    auto n = filled<C>(1);  // product of the null collisions' probabilities
    const Collision<C>* real = nullptr;
    for (int j = 0;; ++j) {
      const Collision<C>* at = collisions.next();
      const float reached = mean_of(path.p * n);
      if (!at || reached == 0) break;
      if (!is_black(at->emission)) radiance += to_color(path.f * n) * at->emission / (reached * at->majorant);
      if (sampler.u1(Decision::RealCollision, bounce, j) * at->majorant < at->sigma_t[leader]) {
        real = at;
        break;
      }
      for (int c = 0; c < C; ++c) {
        n[c] *= std::max(0.0f, 1 - at->sigma_t[c] / at->majorant);
        if (n[c] == 0) collisions.drop(c);
      }
    }
    if (scene.needs.equiangular && !inside.empty()) radiance += leg.about_lights(inside);

    // Goes on from x; false when the path ends.
    const auto turn = [&](Vec3 x, const auto& scatterer) {
      if (bounce == scene.render.bounces) return false;
      const auto scattered = scatter_direction<C>(scatterer, x, bounce, context);
      path.f = path.f * scattered.weight;
      const float pdf = mean_of(path.p);
      if (!(pdf > 0)) return false;
      for (int c = 0; c < C; ++c) path.f[c] /= pdf, path.p[c] /= pdf;
      const float survivors = roulette(to_color(path.f), bounce, context);
      for (float& v : path.f.v) v *= survivors;
      ray = {x, scattered.direction};
      return !is_black(to_color(path.f));
    };
    if (real) {
      radiance += leg.at_collision(*real, n, inside);
      path.f = path.f * n * real->sigma_s;
      path.p = path.p * n * real->sigma_t;
      const PhaseMixture<C> phase(scene, ray.direction, real->densities);
      if (!turn(ray.at(real->t), phase)) return radiance;
    } else {
      if (!surface || mean_of(path.p * n) == 0) return radiance;
      path.f = path.f * n;
      path.p = path.p * n;
      TrackedShadows<C> shadows(bounce, context);
      light_at_surface<C>(*surface, to_color(path.f) / mean_of(path.p), bounce, 2, context.light_samples(), context,
                          shadows);
      radiance += shadows.light();
      if (!turn(surface->position, DiffuseReflection<C>(surface->normal, surface->albedo))) return radiance;
    }
    surface = close(ray, scene);
  }
}

}  // namespace

Color NullScatteringIntegrator::radiance(const Ray& camera_ray, SampleContext& context) const {
  return context.scene.needs.channels == 1 ? trace<1>(camera_ray, context) : trace<3>(camera_ray, context);
}

IntegratorType null_scattering_integrator_type() {
  return {integrator_table("null_scattering", "Null scattering",
                           "Unbiased reference: tracking, equi-angular sampling and channels by MIS (Miller 2019).",
                           {light_params(), majorant_params(), path_params(), random_params()}),
          make_as<NullScatteringIntegrator>};
}

}  // namespace brume
