// The whole renderer against values that were computed twice by other methods (tests/render/reference/*.json).
//
// Every comparison is planned before any is made, because the number of standard errors that each is granted follows
// from how many there are: right values fail the whole run once in a thousand times (Sidak). A comparison that fails is
// repeated with 16 times the samples and another seed; both are reported, and the second decides.
//
// BRUME_TEST_FULL=1 in the environment asks for a third of the noise, and for 0.025 % in the white furnace.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <set>

#include "renderer/core/parallel.h"
#include "tests/support/reference_case.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kNoiseFactor = 8;  // sanitized code is tens of times slower: 64 times fewer samples
#else
constexpr double kNoiseFactor = 1;
#endif

bool full() {
  const char* value = std::getenv("BRUME_TEST_FULL");
  return value && std::string(value) == "1";
}

constexpr double kFamilyError = 1e-3;                                    // right values fail one run in a thousand
constexpr double kFloatError = 1e-5;                                     // relative, of a few hundred roundings of 6e-8
double noise_target() { return kNoiseFactor * (full() ? 1e-3 : 3e-3); }  // standard error over the expected value
double furnace_target() { return kNoiseFactor * (full() ? 2.5e-4 : 1e-3); }
constexpr std::uint64_t kPilotSamples = 1 << 14;
constexpr std::uint64_t kEmissionSamples = 512;  // nothing but the look-up offset is random
std::uint64_t most_samples() { return full() ? 80'000'000 : 8'000'000; }

/// Comparisons whose variance is beyond any sample count that a test can afford, with the reason. They are rendered all
/// the same and their variance is printed; a test fails when one of them has become possible, or when another one has
/// become impossible.
const std::vector<std::pair<std::string, DistanceSampling>>& impossible() {
  using enum DistanceSampling;
  static const std::vector<std::pair<std::string, DistanceSampling>> list{
      // A point light at distance D from the ray inside the medium: the second moment of 1/r^2 under a density that
      // does
      // not know of the light grows as 1/D^3, the relative variance as 1/D.
      {"ss_hom_near_D0.001_g0", Density},
      {"ss_hom_near_D0.001_g0.5", Density},
      {"ss_hom_near_D1e-06_g0", Density},
      {"ss_hom_near_D1e-06_g0.5", Density},
      {"ss_hom_near_D1e-3_st10_caminside", Density},
      // 2000 mean free paths along the ray, light from outside: all is scattered in a skin of 1/1000, which angles that
      // know nothing of the extinction hit once in a thousand samples.
      {"ss_hom_sphere_out_st1000", Equiangular},
  };
  return list;
}

bool is_impossible(const std::string& id, DistanceSampling mode) {
  return std::find(impossible().begin(), impossible().end(), std::pair(id, mode)) != impossible().end();
}

/// A quantity of a case in one mode: up to three comparisons.
struct Job {
  const ReferenceCase* scene;
  const ReferenceQuantity* quantity;
  DistanceSampling mode = DistanceSampling::Mis;
  double step = 0;            // world units; 0: the medium's own
  std::uint64_t offsets = 0;  // look-up positions for an optical depth
  double target = 0;          // relative standard error
  Channels floor = {};        // values below this need not be known better than to `target` of it
  Channels bias = {};         // stated bias of the method, absolute
  Channels floating = {};     // absolute
};

/// Channels with values of their own; grey scenes have one.
std::vector<int> channels_of(const Job& job) {
  std::vector<int> channels{0};
  for (int k = 1; k < 3; ++k)
    if (job.quantity->expected[static_cast<std::size_t>(k)] != job.quantity->expected[static_cast<std::size_t>(k - 1)])
      channels.push_back(k);
  return channels;
}

std::uint64_t seed_of(const Job& job, std::uint64_t salt) {
  std::uint64_t hash = 1469598103934665603ull + salt;
  const std::string text = job.scene->id + "/" + job.quantity->name + "/" + name_of(job.mode);
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return (hash ^ hash >> 32) & 0xffffffffu;
}

struct Outcome {
  std::vector<CaseResult> results;
  double noise = 0;  // largest standard error over max(|expected|, floor)
  Channels relative_deviation = {};
  std::string refused;
};

Outcome judged(const Job& job, const ReferenceEstimate& e, double z) {
  Outcome out;
  out.relative_deviation = e.relative_deviation();
  for (const int channel : channels_of(job)) {
    const auto k = static_cast<std::size_t>(channel);
    out.results.push_back(judge(*job.scene, *job.quantity, job.scene->light.type.empty() ? "-" : name_of(job.mode),
                                channel, e, z, job.floating[k], job.bias[k]));
    const double size = std::max(std::abs(job.quantity->expected[k]), job.floor[k]);
    if (size > 0) out.noise = std::max(out.noise, e.standard_error[k] / size);
  }
  return out;
}

/// As many samples as the pilot says are needed for the target, plus a fifth: the pilot's variance is an estimate too.
/// The samples of the pilot are not used again, or large values would decide how often they are averaged away.
Outcome measure(const Job& job, double z, std::uint64_t salt, std::uint64_t more) {
  ReferenceSettings settings{"decoupled", job.mode, job.step, SamplerKind::Independent, seed_of(job, salt)};
  if (job.offsets > 0) settings.sampler = SamplerKind::Sobol;
  auto probe = ReferenceProbe::make(*job.scene, *job.quantity, settings);
  if (!probe) {
    Outcome out;
    out.refused = probe.error().to_string();
    return out;
  }
  if (job.offsets > 0) return judged(job, probe->optical_depth(job.offsets * more), z);

  const std::uint64_t least = job.quantity->name == "emission" ? kEmissionSamples : kPilotSamples;
  const double spread = judged(job, probe->radiance(least), z).noise * std::sqrt(static_cast<double>(least));
  const double needed = 1.2 * std::pow(spread / job.target, 2);
  std::uint64_t samples = std::clamp(static_cast<std::uint64_t>(std::min(needed, 1e15)), least, most_samples());
  if (is_impossible(job.scene->id, job.mode)) samples = least;
  settings.seed = seed_of(job, salt + 1);
  probe = ReferenceProbe::make(*job.scene, *job.quantity, settings);
  return judged(job, probe->radiance(samples * more), z);
}

// ---- The plan -------------------------------------------------------------------------------------------------------

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

Channels scaled(const Channels& c, double s) { return {c[0] * s, c[1] * s, c[2] * s}; }
Channels extinction(const ReferenceCase& c) {
  return {c.sigma_s[0] + c.sigma_a[0], c.sigma_s[1] + c.sigma_a[1], c.sigma_s[2] + c.sigma_a[2]};
}

/// Optical depth: K stratified offsets of a march at step h are a rectangle rule of spacing h/K, whose error is at most
/// the spacing times the variation of sigma_t along the ray. The step makes that 1e-5 of the optical depth.
Job optical_depth_job(const ReferenceCase& c, const ReferenceQuantity& q) {
  Job job{&c, &q};
  const double length = reference_span(c, q.ray).length(), variation = density_variation(c, q.ray);
  const Channels sigma_t = extinction(c);
  job.offsets = 1024;
  job.step = aligned_step(c, q.ray);
  if (job.step == 0 && variation > 0 && sigma_t[0] > 0) {
    const double column = q.expected[0] / sigma_t[0];
    job.step = std::clamp(1024 * kFloatError * column / variation, length / 60000, length);
    job.bias = scaled(sigma_t, job.step / 1024 * variation);
  }
  const double rounding = column_rounding(c, q.ray);
  for (std::size_t k = 0; k < 3; ++k) job.floating[k] = std::max(kFloatError * q.expected[k], sigma_t[k] * rounding);
  return job;
}

/// Emission: with j and sigma_t in one ratio L = j/sigma_t (1 - exp(-tau_hat)) exactly, where tau_hat = tau + X has
/// mean tau over the offsets and |X| <= M = step * sigma_t * variation. The bias is that of the transmittance (Jensen):
///   0 <= E[exp(-X)] - 1 <= cosh(M) - 1 = O(step^2).
Job emission_job(const ReferenceCase& c, const ReferenceQuantity& q) {
  Job job{&c, &q};
  const double length = reference_span(c, q.ray).length(), variation = density_variation(c, q.ray);
  const Channels sigma_t = extinction(c);
  const double tau = sigma_t[0] * variation;  // heterogeneous cases are grey
  job.target = noise_target();
  job.step = aligned_step(c, q.ray);
  if (job.step == 0 && variation > 0) {
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
  return job;
}

Job scattering_job(const ReferenceCase& c, const ReferenceQuantity& q, DistanceSampling mode, double target) {
  Job job{&c, &q, mode};
  job.target = target;
  job.floating = scaled(q.expected, kFloatError);
  return job;
}

constexpr DistanceSampling kModes[] = {DistanceSampling::Density, DistanceSampling::Equiangular, DistanceSampling::Mis};

/// The parts of the run; one test each.
enum Part { kTransmittance, kEmission, kSingleScattering, kFurnace, kSlabOrders, kParts };
constexpr const char* kPartNames[kParts] = {"transmittance", "emission", "single scattering", "white furnace",
                                            "slabs by order"};

class Reference : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    plan_ = new Plan;
    const char* files[] = {"transmittance", "emission", "single_scatter_homogeneous", "furnace"};
    for (int f = 0; f < 4; ++f) {
      auto cases =
          read_reference_cases(std::string(BRUME_SOURCE_DIR) + "/tests/render/reference/" + files[f] + ".json");
      if (!cases) {
        plan_->refused = cases.error().to_string();
        return;
      }
      plan_->cases[f] = std::move(*cases);
    }
    for (const ReferenceCase& c : plan_->cases[0]) plan_case(c, kTransmittance);
    for (const ReferenceCase& c : plan_->cases[1]) plan_case(c, kEmission);
    for (const ReferenceCase& c : plan_->cases[2]) plan_case(c, kSingleScattering);
    for (const ReferenceCase& c : plan_->cases[3]) plan_case(c, c.has_tag("furnace") ? kFurnace : kSlabOrders);
    int comparisons = 0;
    for (const auto& jobs : plan_->jobs)
      for (const Job& job : jobs) comparisons += static_cast<int>(channels_of(job).size());
    plan_->comparisons = comparisons;
    plan_->z = sidak_z(kFamilyError, comparisons);
  }

  static void plan_case(const ReferenceCase& c, Part part) {
    for (const ReferenceQuantity& q : c.quantities) {
      if (q.name == "optical_depth" && part != kFurnace && part != kSlabOrders) {
        // Of every file's cases: what the integrator reports about a ray is right whatever lights there are.
        plan_->jobs[part].push_back(optical_depth_job(c, q));
      } else if (q.name == "emission" && part == kEmission) {
        plan_->jobs[part].push_back(emission_job(c, q));
      } else if (q.name == "order 1" && part == kSingleScattering) {
        for (const DistanceSampling mode : kModes)
          plan_->jobs[part].push_back(scattering_job(c, q, mode, noise_target()));
      } else if (q.name == "all orders + background" && part == kFurnace) {
        // An environment has no position: every mode draws its distances by density.
        plan_->jobs[part].push_back(scattering_job(c, q, DistanceSampling::Mis, furnace_target()));
      } else if (part == kSlabOrders) {
        static const std::set<std::string> chosen{"order 1", "orders 1..2", "orders 1..10", "all orders + background"};
        if (chosen.contains(q.name))
          plan_->jobs[part].push_back(scattering_job(c, q, DistanceSampling::Mis, noise_target()));
      }
    }
  }

  static void TearDownTestSuite() {
    std::printf("\n%d comparisons, |z| <= %.2f each (family-wise error %g), noise <= %.2g of the value\n",
                plan_->comparisons, plan_->z, kFamilyError, noise_target());
    std::printf("%-20s %6s %12s %12s %14s %14s %8s\n", "", "cases", "comparisons", "largest |z|", "largest noise",
                "largest error", "CPU s");
    for (int p = 0; p < kParts; ++p) {
      const Summary& s = plan_->summary[p];
      std::printf("%-20s %6zu %12d %12.2f %13.3f%% %13.4f%% %8.1f\n", kPartNames[p], s.cases.size(), s.comparisons,
                  s.largest_z, 100 * s.largest_noise, 100 * s.largest_error, s.cpu_seconds);
    }
    for (const std::string& line : plan_->notes) std::printf("%s\n", line.c_str());
    delete plan_;
    plan_ = nullptr;
  }

  void SetUp() override { ASSERT_EQ(plan_->refused, ""); }

  /// Runs all comparisons of a part, repeats those that fail, and reports.
  static void run(Part part) {
    const std::vector<Job>& jobs = plan_->jobs[part];
    ASSERT_FALSE(jobs.empty()) << kPartNames[part];
    const std::clock_t start = std::clock();
    std::vector<Outcome> first(jobs.size()), second(jobs.size());
    parallel_for(static_cast<int>(jobs.size()), [&](int i) {
      const auto j = static_cast<std::size_t>(i);
      first[j] = measure(jobs[j], plan_->z, 0, 1);
      const bool failed =
          std::any_of(first[j].results.begin(), first[j].results.end(), [](const CaseResult& r) { return !r.passed; });
      if (failed && !is_impossible(jobs[j].scene->id, jobs[j].mode)) second[j] = measure(jobs[j], plan_->z, 1000, 16);
    });
    Summary& summary = plan_->summary[part];
    summary.cpu_seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    for (std::size_t j = 0; j < jobs.size(); ++j) report(jobs[j], first[j], second[j], summary);
  }

  static const std::vector<Job>& planned(Part part) { return plan_->jobs[part]; }

  /// Mean over the comparisons of a part that run() has made.
  static double mean_of(Part part) { return plan_->summary[part].value.mean(); }

 private:
  struct Summary {
    std::set<std::string> cases;
    int comparisons = 0;
    double largest_z = 0, largest_noise = 0, largest_error = 0, cpu_seconds = 0;
    RunningMean value;
  };
  struct Plan {
    std::vector<ReferenceCase> cases[4];
    std::vector<Job> jobs[kParts];
    Summary summary[kParts];
    int comparisons = 0;
    double z = 0;
    std::vector<std::string> notes;
    std::string refused;
  };
  static Plan* plan_;

  static void report(const Job& job, const Outcome& first, const Outcome& second, Summary& summary) {
    summary.cases.insert(job.scene->id);
    if (!first.refused.empty()) {
      // What Brume cannot express is no failure of the rendering, but nothing in these four files is of that kind.
      plan_->notes.push_back("unsupported: " + job.scene->id + ": " + first.refused);
      ADD_FAILURE() << plan_->notes.back();
      return;
    }
    if (is_impossible(job.scene->id, job.mode)) {
      char text[200];
      std::snprintf(text, sizeof text,
                    "expected failure: %s %s: relative standard deviation of a sample at least %.3g; more than %.1g "
                    "samples would be needed",
                    job.scene->id.c_str(), name_of(job.mode), first.relative_deviation[0],
                    std::pow(first.relative_deviation[0] / job.target, 2));
      plan_->notes.push_back(text);
      const bool possible = first.noise <= job.target && first.results[0].passed;
      EXPECT_FALSE(possible) << job.scene->id << ' ' << name_of(job.mode) << " is listed as impossible, but it is not";
      return;
    }
    const bool repeated = !second.results.empty();
    const Outcome& last = repeated ? second : first;
    for (std::size_t i = 0; i < last.results.size(); ++i) {
      const CaseResult& r = last.results[i];
      ++summary.comparisons;
      summary.value.add(r.mean);
      summary.largest_z = std::max(summary.largest_z, std::abs(r.z));
      if (r.expected != 0) summary.largest_error = std::max(summary.largest_error, std::abs(r.mean / r.expected - 1));
      if (repeated && !first.results[i].passed)
        plan_->notes.push_back("failed at first: " + first.results[i].to_string());
      if (repeated && !first.results[i].passed) plan_->notes.push_back("   repeated:     " + r.to_string());
      EXPECT_TRUE(r.passed) << (repeated ? "first    " + first.results[i].to_string() + "\nrepeated " : "")
                            << r.to_string();
    }
    summary.largest_noise = std::max(summary.largest_noise, last.noise);
    if (job.offsets == 0) {
      EXPECT_LE(last.noise, 1.2 * job.target)
          << job.scene->id << ' ' << job.quantity->name << ' ' << name_of(job.mode)
          << ": too noisy to judge; relative deviation of a sample " << last.relative_deviation[0];
    }
  }
};

Reference::Plan* Reference::plan_ = nullptr;

TEST_F(Reference, OpticalDepthOfEveryProfile) { run(kTransmittance); }

TEST_F(Reference, EmissionAlongTheCameraRay) { run(kEmission); }

TEST_F(Reference, SingleScatteringInHomogeneousMediaByEveryTechnique) { run(kSingleScattering); }

TEST_F(Reference, WhiteFurnaceGivesOneWithUnlimitedBounces) {
  run(kFurnace);
  // The cases together: ten times 0.1 % (0.025 % when full) make 0.03 %, so that 0.1 % is three standard errors.
  EXPECT_NEAR(mean_of(kFurnace), 1, 1e-3 * kNoiseFactor);
}

TEST_F(Reference, EnvironmentOverSlabsOrderByOrder) { run(kSlabOrders); }

/// The bias that the march states of itself: with one offset U for all steps of a ramp,
///   tau_hat - tau = (U - 1/2) step sigma_t (rho_end - rho_begin),   E[exp(-tau_hat)] = T sinh(x) / x,
/// x = half of that step's rise. It is known in closed form, within the bound cosh(2x) - 1 that every other case uses,
/// and falls with the square of the step.
TEST_F(Reference, StepBiasOfARampIsTheOneStatedAndFallsWithTheSquareOfTheStep) {
  const auto& jobs = planned(kEmission);
  const auto ramp =
      std::find_if(jobs.begin(), jobs.end(), [](const Job& j) { return j.scene->id == "em_linear" && j.offsets == 0; });
  ASSERT_NE(ramp, jobs.end());
  const ReferenceCase& c = *ramp->scene;
  const double sigma_t = c.sigma_a[0], rise = sigma_t * density_variation(c, ramp->quantity->ray);
  const double transmittance = std::exp(-c.quantities[0].expected[0]);
  double last = 0;
  for (const double step : {1.0, 0.5, 0.25}) {
    auto probe =
        ReferenceProbe::make(c, *ramp->quantity, {"decoupled", DistanceSampling::Mis, step, SamplerKind::Sobol, 5});
    ASSERT_TRUE(probe.ok());
    // Stratified offsets: 4096 strata leave an error of the order of the bias over 4096.
    const double measured = ramp->quantity->expected[0] - probe->radiance(4096).mean[0];
    const double x = 0.5 * step * rise, stated = c.emission[0] / sigma_t * transmittance * (std::sinh(x) / x - 1);
    EXPECT_NEAR(measured, stated, 0.005 * stated + 2e-7) << "step " << step;  // 2e-7: rounding of the float radiance
    EXPECT_LE(measured, c.emission[0] / sigma_t * transmittance * (std::cosh(2 * x) - 1));
    if (last > 0) {
      EXPECT_NEAR(last / measured, 4, 0.25) << "step " << step;  // next order: x^2 / 20
    }
    last = measured;
  }
}

}  // namespace
}  // namespace brume
