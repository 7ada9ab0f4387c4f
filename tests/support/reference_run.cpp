#include "tests/support/reference_run.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>

#include "renderer/core/parallel.h"
#include "tests/support/reference_medium.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

constexpr double kFamilyError = 1e-3;  // right values fail one run in a thousand
constexpr double kFloatError = 1e-5;   // relative, of a few hundred roundings of 6e-8
constexpr double kTrackedTransmittanceError = 1e-3;
constexpr double kSecondsPerRay = 0.4e-6;  // roughly; decides only how many samples are taken
constexpr std::uint64_t kPilotSamples = 1 << 12;
constexpr double kMostSegments = 2000, kMostSegmentsSquared = 100;  // the latter where every step marches to the lights
constexpr std::uint64_t kFirstSamples = 64;                         // tell what a sample costs

/// One comparison to be made.
struct Comparison {
  const ReferenceCase* scene;
  const ReferenceQuantity* quantity;
  ReferenceMethod method;
  std::string file;
  double step = 0;       // world units; 0: the medium's own
  bool offsets = false;  // an optical depth: stratified look-ups
  Channels bias = {};    // stated bias of the method, absolute
  Channels floating = {};
};

Channels scaled(const Channels& c, double s) { return {c[0] * s, c[1] * s, c[2] * s}; }
Channels extinction(const ReferenceCase& c) {
  return {c.sigma_s[0] + c.sigma_a[0], c.sigma_s[1] + c.sigma_a[1], c.sigma_s[2] + c.sigma_a[2]};
}
double largest(const Channels& c) { return std::max({c[0], c[1], c[2]}); }

/// Channels with values of their own; grey scenes have one.
std::vector<int> channels_of(const ReferenceQuantity& q) {
  std::vector<int> channels{0};
  for (int k = 1; k < 3; ++k)
    if (q.expected[static_cast<std::size_t>(k)] != q.expected[static_cast<std::size_t>(k - 1)]) channels.push_back(k);
  return channels;
}

/// Step at which every segment of this ray lies within one slab; 0 where there is none.
double aligned_step(const ReferenceCase& c, const ReferenceRay& ray) {
  if (c.density.type != "slabs") return 0;
  const auto& edges = c.density.numbers.at("edges");
  const int axis = static_cast<int>(c.density.numbers.at("axis")[0]);
  const double thickness = edges[1] - edges[0], slope = ray.direction[axis];
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (std::abs(edges[i] - edges[i - 1] - thickness) > 1e-12) return 0;
  const double enters = ray.origin[axis] + ray.direction[axis] * reference_span(c, ray).begin;
  const double slabs = (enters - edges[0]) / thickness;
  return slope != 0 && std::abs(slabs - std::round(slabs)) < 1e-9 ? thickness / std::abs(slope) : 0;
}

// ---- Stated biases --------------------------------------------------------------------------------------------------

/// Optical depth: 1024 stratified offsets of a march at step h are a rectangle rule of spacing h/1024, whose error is
/// at most the spacing times the variation of sigma_t along the ray. The step makes that 1e-5 of the optical depth.
void plan_optical_depth(Comparison& job) {
  const ReferenceCase& c = *job.scene;
  const ReferenceQuantity& q = *job.quantity;
  const double length = reference_span(c, q.ray).length(), variation = density_variation(c, q.ray);
  const Channels sigma_t = extinction(c);
  job.offsets = true;
  job.step = aligned_step(c, q.ray);
  if (job.step == 0 && variation > 0 && sigma_t[0] > 0) {
    const double column = q.expected[0] / sigma_t[0];
    job.step = std::clamp(1024 * kFloatError * column / variation, length / 60000, length);
    job.bias = scaled(sigma_t, job.step / 1024 * variation);
  }
  const double rounding = column_rounding(c, q.ray);
  for (std::size_t k = 0; k < 3; ++k) job.floating[k] = std::max(kFloatError * q.expected[k], sigma_t[k] * rounding);
}

/// Emission: with j and sigma_t in one ratio L = j/sigma_t (1 - exp(-tau_hat)) exactly, where tau_hat = tau + X has
/// mean tau over the offsets and |X| <= M = step * sigma_t * variation. The bias is that of the transmittance (Jensen):
///   0 <= E[exp(-X)] - 1 <= cosh(M) - 1 = O(step^2).
void plan_emission(Comparison& job) {
  const ReferenceCase& c = *job.scene;
  const ReferenceQuantity& q = *job.quantity;
  const double length = reference_span(c, q.ray).length(), variation = density_variation(c, q.ray);
  const Channels sigma_t = extinction(c);
  const double tau = sigma_t[0] * variation;  // heterogeneous cases are grey
  job.step = job.method.tracks() ? 0 : aligned_step(c, q.ray);
  if (!job.method.tracks() && job.step == 0 && variation > 0) {
    job.step = length / 200;
    const auto bias_at = [&](double step) {
      const double column_tau = c.quantities[0].expected[0];
      return sigma_t[0] > 0 ? std::exp(-column_tau) / sigma_t[0] * (std::cosh(step * tau) - 1) : 0.0;
    };
    // Halved until the bias is as small as the float error.
    while (bias_at(job.step) * c.emission[0] > kFloatError * q.expected[0] && job.step > length / 60000)
      job.step *= 0.5;
    job.bias = scaled(c.emission, bias_at(job.step));
  }
  const double rounding = column_rounding(c, q.ray);
  for (std::size_t k = 0; k < 3; ++k) job.floating[k] = kFloatError * q.expected[k] + c.emission[k] * rounding;
}

/// Distance of the light from the ray; infinite for lights without a place.
double light_distance(const ReferenceCase& c, const ReferenceRay& ray) {
  const auto at = c.light.numbers.find("position");
  if (at == c.light.numbers.end()) return std::numeric_limits<double>::infinity();
  const Vec3d p{at->second[0], at->second[1], at->second[2]};
  const double t = std::clamp(dot(p - ray.origin, ray.direction), ray.tmin, ray.tmax);
  return length(p - ray.origin - ray.direction * t);
}

/// Largest change of the density over a length h of the ray, relative to its largest value.
double change_over(const ReferenceCase& c, const ReferenceRay& ray, double h) {
  const ReferenceSpan span = reference_span(c, ray);
  constexpr int kPoints = 4000;
  double change = 0, peak = 1e-300;
  for (int i = 0; i < kPoints; ++i) {
    const double t = span.begin + (i + 0.5) / kPoints * span.length();
    const auto at = [&](double s) { return reference_density(c, ray.origin + ray.direction * std::min(s, span.end)); };
    change = std::max(change, std::abs(at(t + h) - at(t)));
    peak = std::max(peak, at(t));
  }
  return change / peak;
}

/// Scattering in heterogeneous media, relative to the value, for each order. Two transmittances of optical depths
/// tau + X, |X| <= M = step * sigma_t * variation: 2 (cosh(2 M) - 1). And the light is weighted by a scattering
/// coefficient that was looked up elsewhere in the segment: smooth densities change by w over a step, which averages
/// out to w^2 under smooth light and to w under a light nearer than the step; at a jump the segment is wrong as a
/// whole.
double scattering_bias(const ReferenceCase& c, const ReferenceRay& ray, double step) {
  const double length = reference_span(c, ray).length(), distance = light_distance(c, ray);
  const double m = step * largest(extinction(c)) * density_variation(c, ray);
  const bool jumps = c.density.type == "slabs" || c.density.type == "shell";
  const double w = jumps ? 0 : change_over(c, ray, step);
  return 2 * (std::cosh(2 * m) - 1) +
         (jumps ? 2 * step / std::min(length, distance) : w * w + w * std::min(1.0, step / distance));
}

void plan_scattering(Comparison& job) {
  const ReferenceCase& c = *job.scene;
  const ReferenceQuantity& q = *job.quantity;
  // Where rounding the world's coordinates to float moves the answer, the reference asks for 1e-4 of a tool that takes
  // the medium's origin away in double, as Brume does where a scene is far from the world's origin. A ray that grazes a
  // sphere at 1e-6 of its radius has no such origin: 1e-2.
  const bool ill = c.has_tag("float32_ill_conditioned");
  job.floating = scaled(q.expected, !ill ? kFloatError : c.has_tag("grazing") ? 1e-2 : 1e-4);
  if (!c.heterogeneous() || job.method.tracks()) return;
  const double length = reference_span(c, q.ray).length();
  job.step = length / 50;
  const double most = job.method.integrator.starts_with("ray_march") ? kMostSegmentsSquared : kMostSegments;
  while (scattering_bias(c, q.ray, job.step) > 1e-3 && job.step > length / most) job.step *= 0.5;
  job.bias = scaled(q.expected, scattering_bias(c, q.ray, job.step) * (1 + std::min(q.bounces, 100)));
}

// ---- Measuring ------------------------------------------------------------------------------------------------------

std::uint64_t seed_of(const Comparison& job, std::uint64_t salt) {
  std::uint64_t hash = 1469598103934665603ull + salt;
  const std::string text = job.scene->id + "/" + job.quantity->name + "/" + job.method.name();
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return (hash ^ hash >> 32) & 0xffffffffu;
}

struct Measurement {
  std::vector<CaseResult> results;
  double noise = 0, relative_deviation = 0, work = 0;
  std::string refused;

  bool passed() const {
    return std::all_of(results.begin(), results.end(), [](const CaseResult& r) { return r.passed; });
  }
};

Measurement judged(const Comparison& job, const ReferenceEstimate& e, double z) {
  Measurement out;
  out.relative_deviation = largest(e.relative_deviation());
  out.work = e.work;
  for (const int channel : channels_of(*job.quantity)) {
    const auto k = static_cast<std::size_t>(channel);
    ReferenceQuantity q = *job.quantity;
    Channels floating = job.floating;
    if (q.measured == Measured::OpticalDepth && job.method.tracks()) {
      q.name = "transmittance";
      for (double& v : q.expected) v = std::exp(-v);
      floating = {kTrackedTransmittanceError, kTrackedTransmittanceError, kTrackedTransmittanceError};
    }
    out.results.push_back(judge(*job.scene, q, job.method.name(), channel, e, z, floating[k], job.bias[k]));
    if (q.expected[k] != 0) out.noise = std::max(out.noise, e.standard_error[k] / std::abs(q.expected[k]));
  }
  return out;
}

ReferenceEstimate estimate(const Comparison& job, ReferenceProbe& probe, std::uint64_t samples) {
  if (job.offsets) return probe.optical_depth(samples);
  if (job.quantity->measured == Measured::OpticalDepth) return probe.transmittance(samples);
  return job.quantity->measured == Measured::Flux ? probe.flux(samples) : probe.radiance(samples);
}

/// As many samples as the pilot says are needed for the relative error, plus a fifth (the pilot's variance is an
/// estimate too), or as the time allows. The samples of the pilot are not used again, or large values would decide how
/// often they are averaged away.
Measurement measure(const Comparison& job, double z, std::uint64_t salt, std::uint64_t more,
                    const ReferenceOptions& options) {
  ReferenceSettings settings{job.method.integrator, job.method.mode, job.step, SamplerKind::Independent,
                             seed_of(job, salt)};
  if (job.offsets) settings.sampler = SamplerKind::Sobol;
  auto probe = ReferenceProbe::make(*job.scene, *job.quantity, settings);
  if (!probe) {
    Measurement out;
    out.refused = probe.error().to_string();
    return out;
  }
  if (job.offsets) return judged(job, estimate(job, *probe, 1024 * more), z);
  std::uint64_t samples = options.samples.value_or(0);
  if (samples == 0) {
    const double work = judged(job, estimate(job, *probe, kFirstSamples), z).work;
    const double affordable = options.seconds / (kSecondsPerRay * work);
    const double pilots =
        std::clamp(affordable / 4, static_cast<double>(kFirstSamples), static_cast<double>(kPilotSamples));
    const Measurement pilot = judged(job, estimate(job, *probe, static_cast<std::uint64_t>(pilots)), z);
    const double needed = 1.2 * std::pow(pilot.noise / options.relative_error, 2) * pilots;
    samples = static_cast<std::uint64_t>(std::max(std::min(needed, affordable), pilots));
  }
  settings.seed = seed_of(job, salt + 1);
  probe = ReferenceProbe::make(*job.scene, *job.quantity, settings);
  return judged(job, estimate(job, *probe, samples * more), z);
}

// ---- The plan -------------------------------------------------------------------------------------------------------

bool has_place(const ReferenceKind& light) {
  return light.type != "" && light.type != "directional" && light.type != "environment";
}

/// What of a case is measured: everything, or what its own file is about and of long lists (orders times rays) two,
/// other ones from case to case.
std::vector<const ReferenceQuantity*> chosen(const ReferenceCase& c, std::size_t number, bool everything) {
  std::vector<const ReferenceQuantity*> list, rest;
  for (const ReferenceQuantity& q : c.quantities) {
    // The total of a medium without absorption and without end converges like 1/depth only, says the reference.
    if (c.has_tag("semi_infinite") && c.sigma_a[0] == 0 && q.bounces == kUnlimitedBounces) continue;
    const bool one_of_many = q.name.find("order") != std::string::npos && q.name != "order 1";
    (one_of_many ? rest : list).push_back(&q);
  }
  if (everything) {
    list.insert(list.end(), rest.begin(), rest.end());
    return list;
  }
  const std::size_t n = rest.size();
  if (n > 0) list.push_back(rest[number * 7 % n]);
  if (n > 2) list.push_back(rest[(number * 7 + n / 2) % n]);
  return list;
}

void plan_case(const ReferenceCase& c, const std::string& file, std::size_t number, const ReferenceOptions& options,
               std::vector<Comparison>& jobs) {
  for (const ReferenceQuantity* q : chosen(c, number, options.everything))
    for (const ReferenceMethod& method : options.methods) {
      // Distances are drawn about a light only where a light has a place, and only to sample light.
      const bool one_mode = !has_place(c.light) || q->measured == Measured::OpticalDepth || q->name == "emission";
      if (one_mode && method.integrator == "decoupled" && method.mode != DistanceSampling::Mis) continue;
      Comparison job{&c, q, method, file};
      if (q->measured == Measured::OpticalDepth && !method.tracks())
        plan_optical_depth(job);
      else if (q->name == "emission")
        plan_emission(job);
      else
        plan_scattering(job);
      jobs.push_back(std::move(job));
    }
}

}  // namespace

std::string ReferenceMethod::name() const {
  return integrator == "decoupled" ? integrator + " " + name_of(mode) : integrator;
}

bool ReferenceMethod::tracks() const {
  return integrator.find("tracking") != std::string::npos || integrator == "null_scattering";
}

std::vector<ReferenceMethod> default_reference_methods() {
  using enum DistanceSampling;
  return {{"null_scattering"},
          {"decoupled", Density},
          {"decoupled", Equiangular},
          {"decoupled", Mis},
          {"decoupled", Product}};
}

Result<std::vector<ReferenceMethod>> reference_methods(const std::string& key) {
  std::vector<ReferenceMethod> methods;
  std::vector<std::string> known{"all"};
  for (const ReferenceMethod& m : default_reference_methods()) {
    if (m.integrator != "decoupled") continue;
    known.push_back("decoupled:" + std::string(name_of(m.mode)));
    if (key == "all" || key == "decoupled" || key == known.back()) methods.push_back(m);
  }
  for (const IntegratorType& t : integrator_types()) {
    known.push_back(t.table.key);
    // Deep shadow maps are biased by their resolution, without a stated bound: only when asked for by name.
    const bool meant = key == t.table.key || (key == "all" && t.table.key != "ray_march_cached");
    if (meant && t.table.key != "decoupled") methods.push_back({t.table.key});
  }
  if (methods.empty()) return bad_input("found \"" + key + "\", expected one of " + join(known));
  return methods;
}

bool ReferenceOutcome::passed() const {
  const auto& results = last();
  return std::all_of(results.begin(), results.end(), [](const CaseResult& r) { return r.passed; });
}

std::string reference_expected_failure(const ReferenceCase& c, const ReferenceQuantity& q,
                                       const ReferenceMethod& method) {
  if (q.measured == Measured::OpticalDepth || q.name == "emission") return {};
  const bool decoupled = method.integrator == "decoupled", density = method.mode == DistanceSampling::Density;
  const bool free_flights = method.integrator.starts_with("delta_tracking") || method.integrator == "stochastic_march";
  const bool blind = free_flights || method.integrator.starts_with("ray_march") || (decoupled && density);
  if (blind && c.has_tag("near_singular"))
    return "distances that do not know of the light: the second moment of 1/r^2 grows as 1/D^3";
  if (decoupled && method.mode == DistanceSampling::Equiangular && c.id == "ss_hom_sphere_out_st1000")
    return "angles that do not know of the extinction: all light is scattered in a skin of 1/1000";
  if (c.has_tag("sigma_inf") && largest(extinction(c)) >= 1e6)
    return "positions are floats: a mean free path of 1e-6 is a few of their spacings";
  if (free_flights && (c.id.find("_st1e-06") != std::string::npos || c.has_tag("sigma_zero")) &&
      largest(extinction(c)) < 1e-3)
    return "scattering distances that are drawn for the whole way out: a medium this thin is met once in a million";
  // Light that comes through the medium from its other side.
  const bool through = q.name.find("transmit") == 0 || q.name.find("flux T") == 0 || q.name.find("T_mu") == 0 ||
                       c.id == "ss_hom_box_in_st10" || c.id == "ss_hom_box_out_st10";
  if (through && !decoupled && largest(q.expected) < 1e-4)
    return "tracking: through N mean free paths light is met about once in exp(N) samples";
  if (through && c.light.type == "directional" && largest(q.expected) < 2e-5)
    return "nearly all light takes paths that are drawn too rarely to be seen in the samples of a test";
  return {};
}

Result<std::vector<ReferenceOutcome>> run_references(const std::vector<std::string>& files, const std::string& only,
                                                     const ReferenceOptions& options,
                                                     const std::function<void(int, int)>& progress) {
  std::vector<std::vector<ReferenceCase>> cases;
  for (const std::string& file : files) {
    auto read = read_reference_cases(file);
    if (!read) return read.error();
    cases.push_back(std::move(*read));
  }
  std::vector<Comparison> jobs;
  bool found = only.empty();
  for (std::size_t f = 0; f < files.size(); ++f)
    for (std::size_t i = 0; i < cases[f].size(); ++i) {
      if (!only.empty() && cases[f][i].id != only) continue;
      if (!options.tag.empty() && !cases[f][i].has_tag(options.tag)) continue;
      found = true;
      plan_case(cases[f][i], std::filesystem::path(files[f]).stem().string(), i, options, jobs);
    }
  if (!found) return bad_input("found no case \"" + only + "\" in the files");
  int comparisons = 0;
  for (const Comparison& job : jobs) comparisons += static_cast<int>(channels_of(*job.quantity).size());
  const double z = sidak_z(kFamilyError, std::max(1, comparisons));

  std::vector<ReferenceOutcome> outcomes(jobs.size());
  std::mutex mutex;
  int done = 0;
  parallel_for(static_cast<int>(jobs.size()), [&](int i) {
    const auto j = static_cast<std::size_t>(i);
    const Comparison& job = jobs[j];
    ReferenceOutcome& out = outcomes[j];
    out.file = job.file;
    out.id = job.scene->id;
    out.method = job.method.name();
    out.expected_failure = reference_expected_failure(*job.scene, *job.quantity, job.method);
    Measurement m = measure(job, z, 0, 1, options);
    out.unsupported = m.refused;
    out.first = m.results;
    if (m.refused.empty() && !m.passed() && out.expected_failure.empty()) {
      m = measure(job, z, 1000, 16, options);
      out.second = m.results;
    }
    out.noise = m.noise;
    out.relative_deviation = m.relative_deviation;
    const std::lock_guard lock(mutex);
    if (progress) progress(++done, static_cast<int>(jobs.size()));
  });
  return outcomes;
}

}  // namespace brume
