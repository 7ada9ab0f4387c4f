// The whole renderer against values that were computed twice by other methods (tests/render/reference/*.json). How
// comparisons are planned, measured and judged is told in tests/support/reference_run.h.
//
// BRUME_TEST_FULL=1 in the environment asks for every quantity of every case, and a third of the noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include "tests/support/effort.h"
#include "tests/support/reference_medium.h"
#include "tests/support/reference_table.h"
#include "tests/support/statistics.h"

namespace brume {
namespace {

/// 64 times fewer samples where a sanitizer makes the code tens of times slower.
constexpr double kNoiseFactor = kFewer == 1 ? 1 : 8;

std::string file(const std::string& name) { return BRUME_SOURCE_DIR "/tests/render/reference/" + name + ".json"; }

const std::vector<std::string>& all_files() {
  static const std::vector<std::string> files = [] {
    std::vector<std::string> list;
    for (const auto& entry : std::filesystem::directory_iterator(BRUME_SOURCE_DIR "/tests/render/reference"))
      if (entry.path().extension() == ".json") list.push_back(entry.path().string());
    std::sort(list.begin(), list.end());
    return list;
  }();
  return files;
}

std::vector<ReferenceOutcome> run(const std::vector<std::string>& files, const ReferenceOptions& options) {
  auto outcomes = run_references(files, "", options);
  EXPECT_TRUE(outcomes.ok()) << outcomes.error().to_string();
  if (!outcomes) return {};
  std::printf("%s", format_summary(*outcomes).c_str());
  for (const ReferenceOutcome& o : *outcomes) {
    if (!o.second.empty() || !o.expected_failure.empty()) std::printf("%s", format_outcomes({o}).c_str());
    EXPECT_EQ(o.unsupported, "") << o.id;
    if (o.expected_failure.empty()) EXPECT_TRUE(o.passed()) << format_outcomes({o});
  }
  return std::move(*outcomes);
}

/// The four modes of decoupled marching where they can be held against closed forms.
TEST(Reference, TransmittanceEmissionAndSingleScatteringWithinThreeInAThousand) {
  const double noise = kNoiseFactor * (full_effort() ? 1e-3 : 3e-3);
  ReferenceOptions options;
  options.methods = *reference_methods("decoupled");
  options.relative_error = 0.85 * noise;  // the pilot that it is planned by is noisy itself
  options.seconds = 100;
  for (const ReferenceOutcome& o :
       run({file("transmittance"), file("emission"), file("single_scatter_homogeneous")}, options))
    for (const CaseResult& r : o.last()) {
      constexpr double kFloor = 1e-9;  // the values of these files go from 1e-10 to 1e5
      if (o.expected_failure.empty())
        EXPECT_LE(r.standard_error, noise * std::max(std::abs(r.expected), kFloor)) << "too noisy: " << r.to_string();
    }
}

/// A medium that absorbs nothing, in light that is the same all around, cannot be told from that light.
// O2 of the catalogue.
TEST(Reference, WhiteFurnaceGivesOneWithUnlimitedBounces) {
  ReferenceOptions options;
  options.methods = *reference_methods("decoupled:mis");
  options.relative_error = kNoiseFactor * (full_effort() ? 2.5e-4 : 1e-3);
  options.seconds = 100;
  options.tag = "furnace";
  RunningMean mean;
  for (const ReferenceOutcome& o : run({file("furnace")}, options))
    for (const CaseResult& r : o.last())
      if (r.quantity == "all orders + background" && r.expected == 1) mean.add(r.mean);
  ASSERT_GE(mean.count(), 10u);
  // The cases together: ten times 0.1 % (0.025 % when full) make 0.03 %, so that 0.1 % is three standard errors.
  EXPECT_NEAR(mean.mean(), 1, 1e-3 * kNoiseFactor);
}

/// All 365 cases by the unbiased reference integrator and by decoupled marching in every mode.
TEST(AllReferences, HoldForTheReferenceIntegratorAndForDecoupledMarching) {
  ReferenceOptions options;
  options.relative_error = kNoiseFactor * (full_effort() ? 1e-3 : 3e-3);
  // When full there are twenty thousand comparisons.
  options.seconds = (full_effort() ? 0.5 : 0.04) / (kNoiseFactor * kNoiseFactor);
  options.everything = full_effort();
  const auto outcomes = run(all_files(), options);

  std::set<std::string> measured, all;
  for (const ReferenceOutcome& o : outcomes) measured.insert(o.id);
  for (const std::string& name : all_files()) {
    const auto cases = *read_reference_cases(name);
    for (const ReferenceCase& c : cases) all.insert(c.id);
  }
  EXPECT_EQ(all.size(), 365u);
  // Two are about diffuse light from one side only, which has no light source in a scene file; the four with a property
  // instead of a number have a test of their own.
  const std::set<std::string> elsewhere{
      "pub_disort_1c", "ed_light_on_ray_inside", "ed_camera_at_light_inside", "ed_box_face_slide",
      "ed_g1",         "pub_disort_1f"};
  for (const std::string& id : all) EXPECT_NE(measured.contains(id), elsewhere.contains(id)) << id;
}

/// Where the right value is no number: what must hold is told in the cases' `property`.
TEST(Reference, DegenerateCasesGiveWhatTheyMust) {
  const auto cases = *read_reference_cases(file("numerical_edge"));
  for (const ReferenceCase& c : cases) {
    if (c.property.empty()) continue;
    for (const ReferenceMethod& method : default_reference_methods()) {
      ReferenceQuantity q;
      q.ray = c.ray;
      auto probe = ReferenceProbe::make(c, q, {method.integrator, method.mode, 0, SamplerKind::Independent, 1});
      ASSERT_TRUE(probe.ok()) << probe.error().to_string();
      const ReferenceEstimate radiance = probe->radiance(20000);
      EXPECT_EQ(radiance.non_finite, 0u) << c.id << ' ' << method.name() << ": " << c.property;
      EXPECT_GE(radiance.mean[0], 0) << c.id << ' ' << method.name() << ": " << c.property;
      if (c.id == "ed_g1") EXPECT_LT(radiance.mean[0], 1e-3) << method.name() << ": " << c.property;
      if (c.id == "ed_box_face_slide" && !method.tracks()) {
        const double t = probe->transmittance(16).mean[0];
        EXPECT_TRUE(std::abs(t - 1) < 1e-6 || std::abs(t - std::exp(-2)) < 1e-6) << t << ": " << c.property;
      }
    }
  }
}

/// The bias that the march states of itself: with one offset U for all steps of a ramp,
///   tau_hat - tau = (U - 1/2) step sigma_t (rho_end - rho_begin),   E[exp(-tau_hat)] = T sinh(x) / x,
/// x = half of that step's rise. It is known in closed form, within the bound cosh(2x) - 1 that every other case uses,
/// and falls with the square of the step.
TEST(Reference, StepBiasOfARampIsTheOneStatedAndFallsWithTheSquareOfTheStep) {
  const auto cases = *read_reference_cases(file("emission"));
  const auto ramp =
      std::find_if(cases.begin(), cases.end(), [](const ReferenceCase& c) { return c.id == "em_linear"; });
  ASSERT_NE(ramp, cases.end());
  const ReferenceCase& c = *ramp;
  const ReferenceQuantity &depth = c.quantities[0], &emission = c.quantities[1];
  ASSERT_EQ(emission.name, "emission");
  const double sigma_t = c.sigma_a[0], rise = sigma_t * density_variation(c, emission.ray);
  const double transmittance = std::exp(-depth.expected[0]);
  double last = 0;
  for (const double step : {1.0, 0.5, 0.25}) {
    auto probe = ReferenceProbe::make(c, emission, {"decoupled", DistanceSampling::Mis, step, SamplerKind::Sobol, 5});
    ASSERT_TRUE(probe.ok());
    // Stratified offsets: 4096 strata leave an error of the order of the bias over 4096.
    const double measured = emission.expected[0] - probe->radiance(4096).mean[0];
    const double x = 0.5 * step * rise, stated = c.emission[0] / sigma_t * transmittance * (std::sinh(x) / x - 1);
    EXPECT_NEAR(measured, stated, 0.005 * stated + 2e-7) << "step " << step;  // 2e-7: rounding of the float radiance
    EXPECT_LE(measured, c.emission[0] / sigma_t * transmittance * (std::cosh(2 * x) - 1));
    if (last > 0) {
      EXPECT_NEAR(last / measured, 4, 0.25) << "step " << step;  // next order: x^2 / 20
    }
    last = measured;
  }
}

/// With a point light inside the medium the variance of orders from the second on is infinite (logarithmically) when
/// directions follow the phase function alone, and grows with the number of samples. It must not.
TEST(Reference, VarianceIsFiniteWithALampInsideTheMedium) {
  const auto cases = *read_reference_cases(file("multiple_sphere"));
  const auto lamp = std::find_if(cases.begin(), cases.end(), [](const ReferenceCase& c) {
    return c.light.type == "point" && c.has_tag("centre_light");
  });
  const auto any =
      std::find_if(cases.begin(), cases.end(), [](const ReferenceCase& c) { return c.light.type == "point"; });
  const ReferenceCase& c = lamp != cases.end() ? *lamp : *any;
  const auto q = std::find_if(c.quantities.begin(), c.quantities.end(),
                              [](const ReferenceQuantity& x) { return x.name == "orders 1..2"; });
  ASSERT_NE(q, c.quantities.end());
  for (const char* integrator : {"decoupled", "null_scattering"}) {
    auto probe = ReferenceProbe::make(c, *q, {integrator, DistanceSampling::Mis, 0, SamplerKind::Independent, 3});
    ASSERT_TRUE(probe.ok());
    const double few = probe->radiance(100000).relative_deviation()[0];
    const double many = probe->radiance(full_effort() ? 10'000'000 : 2'000'000).relative_deviation()[0];
    EXPECT_NEAR(many * many / (few * few), 1, 0.2) << integrator << ": " << few << " and " << many;
  }
}

}  // namespace
}  // namespace brume
