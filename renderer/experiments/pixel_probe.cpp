#include "renderer/experiments/pixel_probe.h"

#include <algorithm>
#include <cmath>

#include "renderer/integrators/direct_light.h"
#include "renderer/integrators/light_batch.h"
#include "renderer/integrators/marched_path.h"
#include "renderer/integrators/path.h"
#include "renderer/march/distribute.h"

namespace brume {
namespace {

constexpr std::size_t kMostLights = 2;
constexpr int kShownPasses = 16;

double mean_of_channels(const auto& channels, int i) {
  double sum = 0;
  for (const auto& channel : channels) sum += double(channel[i]);
  return sum / static_cast<double>(channels.size());
}

template <int C> RayProfile profile_of(const Scene& scene, Ray ray, SampleContext& context) {
  RayProfile out;
  static_cast<void>(close(ray, scene));
  const ArenaScope scope(context.arena);
  MarchRecord<C> rec = record_ray<C>(ray, {scene.step_size, 0.5f, scene.render.time, scene.needs.product}, context);
  if (rec.empty()) return out;
  distribute(rec, Color(1), context.arena);
  const auto n = static_cast<std::size_t>(rec.n);
  out.t.assign(rec.t, rec.t + n + 1);
  for (int i = 0; i <= rec.n; ++i) out.transmittance.push_back(mean_of_channels(rec.transmittance, i));
  for (int i = 0; i < rec.n; ++i) out.sigma_t.push_back(mean_of_channels(rec.sigma_t, i));
  if (!(rec.scattered() > 0)) return out;
  const auto per_unit = [&](double probability, std::size_t i) { return probability / (out.t[i + 1] - out.t[i]); };
  for (int i = 0; i < rec.n; ++i)
    out.density_pdf.push_back(per_unit(double(rec.probability(i)), static_cast<std::size_t>(i)));
  const float* const p = scattered_by_segment(rec, context.arena);
  for (std::size_t l = 0; l < scene.lights.size() && out.lights.size() < kMostLights; ++l) {
    const Light& light = *scene.lights[l];
    const LightPoint point = light.sample_point({0.5f, 0.5f});
    if (point.kind != LightPoint::Kind::Finite) continue;
    RayProfile::OfLight& of_light = out.lights.emplace_back(RayProfile::OfLight{l, std::vector<double>(n), {}});
    if (const Interval lit = lit_part(rec, ray, light, point); !lit.empty()) {
      const EquiangularDistribution equiangular(ray, point.position, lit);  // 0 beyond the lit part
      for (std::size_t i = 0; i < n; ++i)
        of_light.equiangular_pdf[i] = double(equiangular.pdf(0.5f * (rec.t[i] + rec.t[i + 1])));
    }
    const auto pivot = light.pivot();
    if (!pivot) continue;
    const ProductSampling<C> product = product_sampling(rec, p, ray, scene, light, *pivot, context.arena);
    if (!(product.total() > 0)) continue;
    for (int i = 0; i < rec.n; ++i)
      of_light.product_pdf.push_back(per_unit(double(product.probability(i)), static_cast<std::size_t>(i)));
  }
  return out;
}

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

/// A value for each segment, as a share of the largest: steps.
Series steps(const std::string& name, Rgb color, const std::vector<double>& t, const std::vector<double>& values) {
  const double most = largest(values);
  Series series{name, color, {}, LineStyle::Solid, false};
  for (std::size_t i = 0; i < values.size() && most > 0; ++i)
    for (const double edge : {t[i], t[i + 1]}) series.points.push_back({edge, values[i] / most});
  return series;
}

}  // namespace

std::optional<PixelProbe> probe_pixel(const Scene& scene, const Integrator& integrator, const ProbeOptions& options,
                                      const std::stop_token& cancel) {
  PixelProbe out;
  out.place = options.place;
  const PixelPlace& p = options.place;
  const auto width = static_cast<float>(p.width), height = static_cast<float>(p.height);
  const Ray middle = scene.camera.ray((static_cast<float>(p.x) + 0.5f) / width,
                                      (static_cast<float>(p.y) + 0.5f) / height, width / height);
  Arena arena;
  RayStatistics statistics;
  Vec3d mean, m2, depth, transmittance;  // Welford, as Film
  double carried[4] = {};
  for (int pass = 0; pass < options.samples; ++pass) {
    if (cancel.stop_requested()) return std::nullopt;
    RayDiagnostics met;
    const SamplerPass numbers(scene.render.sampler, scene.render.seed, static_cast<std::uint32_t>(pass));
    const Color c = sample_pixel({scene, integrator, numbers}, options.place, arena, statistics, &met);
    if (!is_finite(c)) {
      ++out.non_finite;
      continue;
    }
    const double n = ++out.samples;
    for (int k = 0; k < 3; ++k) {
      const double delta = double(c[k]) - mean[k];
      mean[k] += delta / n;
      m2[k] += delta * (double(c[k]) - mean[k]);
      depth[k] += (double(met.optical_depth[k]) - depth[k]) / n;
      transmittance[k] += (double(met.transmittance[k]) - transmittance[k]) / n;
    }
    out.segments += (met.segments - out.segments) / n;
    for (const LightSampleNote& note : met.light_samples) {
      carried[static_cast<std::size_t>(note.technique)] += double(note.carried);
      if (pass < kShownPasses)
        out.light_samples.push_back(
            {double(length(note.position - middle.origin)), note.technique, double(note.carried)});
    }
  }
  for (int k = 0; k < 3; ++k) {
    out.radiance[k] = static_cast<float>(mean[k]);
    out.variance[k] = static_cast<float>(out.samples > 1 ? m2[k] / (out.samples - 1) : 0);
    out.optical_depth[k] = static_cast<float>(depth[k]);
    out.transmittance[k] = static_cast<float>(transmittance[k]);
  }
  const double all = carried[0] + carried[1] + carried[2] + carried[3];
  if (all > 0) {
    out.density_share = carried[static_cast<std::size_t>(DistanceTechnique::Density)] / all;
    out.equiangular_share = carried[static_cast<std::size_t>(DistanceTechnique::Equiangular)] / all;
    out.product_share = carried[static_cast<std::size_t>(DistanceTechnique::Product)] / all;
  }

  const Sampler none(SamplerKind::Independent, 0, 0, 0);
  SampleContext context{scene, none, arena, statistics};
  out.profile =
      scene.needs.channels == 1 ? profile_of<1>(scene, middle, context) : profile_of<3>(scene, middle, context);
  return out;
}

Chart chart_of(const PixelProbe& probe, const Scene& scene) {
  const RayProfile& profile = probe.profile;
  Chart chart;
  chart.x.label = "distance (world units)";
  chart.y.label = "share of the maximum";
  chart.y.low = 0, chart.y.high = 1.08;
  if (profile.t.empty()) return chart;
  chart.x.low = profile.t.front(), chart.x.high = profile.t.back();

  chart.series.push_back(steps("sigma_t", series_color(7), profile.t, profile.sigma_t));
  Series transmittance{"T", series_color(0), {}, LineStyle::Dashed, false};
  for (std::size_t i = 0; i < profile.t.size(); ++i)
    transmittance.points.push_back({profile.t[i], profile.transmittance[i]});
  chart.series.push_back(std::move(transmittance));
  if (!profile.density_pdf.empty())
    chart.series.push_back(steps("density", series_color(1), profile.t, profile.density_pdf));
  const bool by_product = scene.render.distance_sampling == DistanceSampling::Product;
  for (std::size_t l = 0; l < profile.lights.size(); ++l) {
    const RayProfile::OfLight& of_light = profile.lights[l];
    const std::string about = profile.lights.size() > 1 ? " " + std::to_string(of_light.light + 1) : "";
    chart.series.push_back(steps("angle" + about, series_color(2 + 2 * l), profile.t, of_light.equiangular_pdf));
    if (by_product && !of_light.product_pdf.empty())
      chart.series.push_back(steps("product" + about, series_color(3 + 2 * l), profile.t, of_light.product_pdf));
  }

  double most = 0;
  for (const PixelProbe::LightSample& s : probe.light_samples) most = std::max(most, s.carried);
  const auto drawn_by = [&](DistanceTechnique technique, const char* name, Rgb color) {
    Series series{name, color, {}, LineStyle::None, true};
    for (const PixelProbe::LightSample& s : probe.light_samples)
      if (s.technique == technique && most > 0) series.points.push_back({s.t, s.carried / most});
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  };
  drawn_by(DistanceTechnique::Density, "by density", series_color(1));
  drawn_by(DistanceTechnique::Equiangular, "by angle", series_color(2));
  drawn_by(DistanceTechnique::Product, "by product", series_color(3));
  drawn_by(DistanceTechnique::Other, "samples", series_color(5));
  return chart;
}

}  // namespace brume
