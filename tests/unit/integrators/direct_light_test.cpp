// Light samples: that they add up to the right light in every arrangement, and how noisy they are.
#include "renderer/integrators/direct_light.h"
#include "renderer/integrators/phase_mixture.h"

#include <gtest/gtest.h>

#include "renderer/phase/henyey_greenstein.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;
double bound(int comparisons) { return sidak_z(1e-3, comparisons); }

/// A ray of length 10 through a wide homogeneous fog, with a point light at distance D from its middle.
Node fog(double sigma, double D, const char* mode) {
  Node scene = empty_scene();
  set(scene, "render.sampler", "independent");
  set(scene, "render.distance_sampling", mode);
  Node& v = add_volume(scene, "homogeneous");
  set(v, "bounds.min", "0,-50,-50");
  set(v, "bounds.max", "10,50,50");
  set(v, "albedo", "1,1,1");
  set(v, "density_scale", format_value(sigma));
  Node& lamp = add_light(scene, "point");
  set(lamp, "position", format_value(Numbers{5, D, 0}));
  set(lamp, "intensity", "1,1,1");
  return scene;
}
const Ray kRay{{0, 0, 0}, {1, 0, 0}};

/// The same in double: integrand, densities, and moments over the angle, in which all of them are smooth.
struct FogTheory {
  double sigma, D;
  double f(double t) const {
    const double r2 = D * D + (t - 5) * (t - 5);
    return sigma * kInv4PiD * std::exp(-sigma * (t + std::sqrt(r2))) / r2;
  }
  double density_pdf(double t) const { return sigma * std::exp(-sigma * t) / -std::expm1(-10 * sigma); }
  double equi_pdf(double t) const { return D / (2 * std::atan(5 / D) * (D * D + (t - 5) * (t - 5))); }
  double integral(const std::function<double(double)>& of_t) const {
    return integrate(
        [&](double theta) {
          const double c = std::cos(theta);
          return of_t(5 + D * std::tan(theta)) * D / (c * c);
        },
        -std::atan(5 / D), std::atan(5 / D), 20000);
  }
  double mean() const {
    return integral([this](double t) { return f(t); });
  }
  /// Variance of one sample drawn by `pdf` and weighted by `weight`.
  double variance(const std::function<double(double)>& pdf, const std::function<double(double)>& weight) const {
    const double first = integral([&](double t) { return weight(t) * f(t); });
    return integral([&](double t) { return weight(t) * weight(t) * f(t) * f(t) / pdf(t); }) - first * first;
  }
  double relative_deviation_density() const {
    return std::sqrt(variance([this](double t) { return density_pdf(t); }, [](double) { return 1.0; })) / mean();
  }
  double relative_deviation_equi() const {
    return std::sqrt(variance([this](double t) { return equi_pdf(t); }, [](double) { return 1.0; })) / mean();
  }
  /// One sample of each technique.
  double relative_deviation_mis(double power) const {
    const auto weight = [this, power](double t, bool density) {
      const double d = std::pow(density_pdf(t), power), e = std::pow(equi_pdf(t), power);
      return (density ? d : e) / (d + e);
    };
    return std::sqrt(variance([this](double t) { return density_pdf(t); }, [&](double t) { return weight(t, true); }) +
                     variance([this](double t) { return equi_pdf(t); }, [&](double t) { return weight(t, false); })) /
           mean();
  }
};

// A1, A2 and A3 of the catalogue: the noise of each technique is what the second moments of the estimator say.
TEST(DirectLight, NoiseOfEveryTechniqueIsThatOfTheory) {
  for (const auto& [sigma, D] : {std::pair(0.1, 0.1), std::pair(1.0, 1.0), std::pair(0.1, 1.0), std::pair(1.0, 3.0)}) {
    const FogTheory theory{sigma, D};
    const auto measure = [&](const char* mode, const char* samples, const char* heuristic) {
      Node scene = fog(sigma, D, mode);
      set(scene, "render.light_samples", samples);
      set(scene, "render.mis_heuristic", heuristic);
      const RayEstimate e = estimate(*committed(scene), kRay, 200000);
      EXPECT_LT(std::abs(z_score(e, theory.mean())), bound(16)) << mode << ", sigma " << sigma << ", D " << D;
      return e.relative_deviation();
    };
    const double density = measure("density", "1", "power"), equi = measure("equi_angular", "1", "power");
    const double power = measure("mis", "2", "power"), balance = measure("mis", "2", "balance");
    // 200 000 samples know a variance to sqrt(kurtosis / n): a few per cent for the long tails here.
    EXPECT_NEAR(density / theory.relative_deviation_density(), 1, 0.1) << "sigma " << sigma << ", D " << D;
    EXPECT_NEAR(equi / theory.relative_deviation_equi(), 1, 0.1) << "sigma " << sigma << ", D " << D;
    EXPECT_NEAR(power / theory.relative_deviation_mis(2), 1, 0.05) << "sigma " << sigma << ", D " << D;
    EXPECT_NEAR(balance / theory.relative_deviation_mis(1), 1, 0.05) << "sigma " << sigma << ", D " << D;
  }
}

// The table under A3: D = 0.01, sigma = 0.1, one sample of each technique, per sample; to the digits printed there.
TEST(DirectLight, NoiseOfMisNextToALampIsThatOfTheCatalogue) {
  Node scene = fog(0.1, 0.01, "equi_angular");
  EXPECT_NEAR(estimate(*committed(scene), kRay, 100000).relative_deviation(), 0.02, 0.005);
  set(scene, "render.distance_sampling", "mis");
  set(scene, "render.light_samples", "2");
  // Of a pair; the catalogue's numbers are per sample, larger by the root of 2.
  EXPECT_NEAR(estimate(*committed(scene), kRay, 200000).relative_deviation() * std::sqrt(2.0), 0.27, 0.03);
  set(scene, "render.mis_heuristic", "balance");
  EXPECT_NEAR(estimate(*committed(scene), kRay, 200000).relative_deviation() * std::sqrt(2.0), 0.31, 0.03);
}

// O3 and B7 of the catalogue: in a thin fog the light of a lamp is sigma_s p I (theta_b - theta_a) / D, without noise.
TEST(DirectLight, AirlightOfAThinFogIsExactInOneSample) {
  for (const double sigma : {1e-8, 1e-12})
    for (const double D : {0.1, 1.0, 20.0}) {
      const RayEstimate e = estimate(*committed(fog(sigma, D, "equi_angular")), kRay, 2000);
      const double expected =
          sigma * kInv4PiD * 2 * std::atan(5 / D) / D;  // optical depths of 1e-7 and less are left out
      EXPECT_NEAR(e.mean() / expected, 1, 1e-5) << "sigma " << sigma << ", D " << D;
      EXPECT_LT(e.relative_deviation(), 1e-5) << "sigma " << sigma << ", D " << D;
    }
}

// A7 and O7 of the catalogue: a one-sided square of side S at height h over a thin fog. The light point comes first,
// and the angles are about that very point; about the centre of the square the noise would be 3.9, 28 and 65.
TEST(DirectLight, NoiseUnderALargeNearQuadIsThatOfThePointFirstOrder) {
  for (const auto& [side, noise] : {std::pair(1.0, 1.2), std::pair(4.0, 2.7), std::pair(8.0, 3.9)}) {
    Node scene = fog(1e-4, 1, "equi_angular");
    scene.list("lights").clear();
    Node& quad = add_light(scene, "quad");
    set(quad, "corner", format_value(Numbers{5 - side / 2, 0.1, -side / 2}));
    set(quad, "edge_u", format_value(Numbers{side, 0, 0}));
    set(quad, "edge_v", format_value(Numbers{0, 0, side}));  // x cross z = -y: down at the ray
    const RayEstimate e = estimate(*committed(scene), kRay, 400000);
    EXPECT_NEAR(e.relative_deviation() / noise, 1, 0.15) << "S = " << side;  // two digits, and a long tail
  }
}

TEST(DirectLight, AnyNumberOfLightSamplesInAnyModeGivesTheSameLight) {
  const FogTheory theory{0.5, 0.7};
  int comparisons = 0;
  for (const char* mode : {"density", "equi_angular", "mis", "product"})
    for (const char* heuristic : {"power", "balance"})
      for (const char* samples : {"1", "2", "3", "4", "5", "16"}) {
        Node scene = fog(0.5, 0.7, mode);
        set(scene, "render.light_samples", samples);
        set(scene, "render.mis_heuristic", heuristic);
        set(scene, "render.seed", std::to_string(++comparisons));
        // Pairs of passes: in MIS the odd sample takes turns between the techniques.
        const RayEstimate e = estimate(*committed(scene), kRay, 40000, 2);
        EXPECT_LT(std::abs(z_score(e, theory.mean())), bound(48))
            << mode << ", " << heuristic << ", " << samples << " samples: " << e.mean() << " instead of "
            << theory.mean();
        EXPECT_LT(e.standard_error(), 0.01 * theory.mean());
      }
}

TEST(DirectLight, MoreLightSamplesAreStratifiedAndReduceTheNoiseFasterThanTheirNumber) {
  const auto noise = [](const char* mode, const char* samples) {
    Node scene = fog(0.5, 0.7, mode);
    set(scene, "render.light_samples", samples);
    return estimate(*committed(scene), kRay, 20000).relative_deviation();
  };
  for (const char* mode : {"density", "equi_angular", "product"})
    EXPECT_LT(noise(mode, "16"), 0.5 * noise(mode, "1") / 4) << mode;
  EXPECT_LT(noise("mis", "16"), 0.6 * noise("mis", "2") / std::sqrt(8.0));
}

// With one light sample MIS uses the other technique in every other pass, and pixels differ in which they begin with,
// so that a single pass is right on average over the pixels.
TEST(DirectLight, EverySinglePassOfMisIsUnbiasedOverThePixels) {
  const FogTheory theory{0.5, 0.7};
  for (const char* sampler : {"independent", "sobol"}) {
    Node scene = fog(0.5, 0.7, "mis");
    set(scene, "render.sampler", sampler);
    const auto s = committed(scene);
    const auto integrator = make_integrator(*s);
    Arena arena;
    RayStatistics statistics;
    for (const std::uint32_t pass : {0u, 1u, 6u}) {
      RunningMean mean;
      for (std::uint32_t pixel = 0; pixel < 100000; ++pixel) {
        const Sampler random(s->render.sampler, 1, pixel, pass);
        SampleContext context{*s, random, arena, statistics};
        mean.add(double(integrator->radiance(kRay, context).r));
      }
      EXPECT_LT(std::abs(mean.mean() - theory.mean()) / mean.standard_error(), bound(6))
          << sampler << ", pass " << pass;
    }
  }
}

// The rows of Sobol' points that one technique gets in MIS are every other point of a sequence.
TEST(DirectLight, SobolAndIndependentNumbersGiveTheSameLightAndSobolLessNoise) {
  const FogTheory theory{0.5, 0.7};
  for (const char* mode : {"density", "equi_angular", "mis", "product"}) {
    RunningMean of_pixels[2];
    for (int k = 0; k < 2; ++k) {
      Node scene = fog(0.5, 0.7, mode);
      set(scene, "render.sampler", k == 0 ? "independent" : "sobol");
      const auto s = committed(scene);
      for (std::uint32_t pixel = 0; pixel < 400; ++pixel) of_pixels[k].add(estimate(*s, kRay, 128, 1, pixel).mean());
      EXPECT_LT(std::abs(of_pixels[k].mean() - theory.mean()) / of_pixels[k].standard_error(), bound(6))
          << mode << ' ' << k;
    }
    // 400 pixels know a variance to 7 %: a quarter off is no chance.
    EXPECT_LT(of_pixels[1].variance(), 0.75 * of_pixels[0].variance()) << mode;
  }
}

// What scatters at a place and the light that arrives there vary together inside a step, and must be multiplied before
// they are averaged: four steps through a ramp give the light of the ramp, not that of its mean.
TEST(DirectLight, LightAndMediumOfOnePlaceAreTakenTogether) {
  constexpr double kSlope = 1e-8;  // optical depths of 1e-5 and less are left out
  for (const double D : {0.5, 3.0, 40.0}) {
    Node scene = fog(1, D, "density");
    scene.list("volumes").clear();
    Node& ramp = add_volume(scene, "linear");
    set(ramp, "bounds.min", "0,-50,-50");
    set(ramp, "bounds.max", "10,50,50");
    set(ramp, "albedo", "1,1,1");
    set(ramp, "gradient", "1,0,0");
    set(ramp, "offset", "0");
    set(ramp, "density_scale", format_value(kSlope));
    const double expected =
        integrate([&](double t) { return kSlope * t * kInv4PiD / (D * D + (t - 5) * (t - 5)); }, 0, 10, 2000);
    for (const char* mode : {"density", "equi_angular", "mis", "product", "ray_march"}) {
      const bool marched = mode == std::string("ray_march");
      set(scene, "render.integrator", marched ? mode : "decoupled");
      if (!marched) set(scene, "render.distance_sampling", mode);
      // Near the lamp MIS weighs by the densities of two offsets, and product sampling takes the record for the place
      // that 1/r^2 demands: both err by the square of the step there.
      const bool errs = D < 15 && (mode == std::string("mis") || mode == std::string("product"));
      set(scene, "render.step_size", errs ? "0.25" : "2.5");
      const RayEstimate e = estimate(*committed(scene), kRay, 200000, 2);
      EXPECT_LT(std::abs(z_score(e, expected)), bound(15)) << mode << ", D = " << D << ": " << e.mean() / expected;
      EXPECT_LT(e.standard_error(), 0.005 * expected) << mode << ", D = " << D;
    }
  }
}

TEST(DirectLight, PickingOneLightGivesTheLightOfAll) {
  Node scene = fog(0.3, 1, "mis");
  set(scene, "render.bounces", "1");
  Node& quad = add_light(scene, "quad");
  set(quad, "corner", "2,3,-1");
  set(quad, "edge_u", "3,0,0");
  set(quad, "edge_v", "0,0,2");
  set(add_light(scene, "directional"), "irradiance", "0.5,0.3,0.1");
  set(add_light(scene, "environment"), "radiance", "0.1,0.2,0.3");
  const RayEstimate all = estimate(*committed(scene), kRay, 60000, 2);
  set(scene, "render.light_selection", "one");
  set(scene, "render.seed", "2");
  for (const char* samples : {"1", "3"}) {
    set(scene, "render.light_samples", samples);
    const RayEstimate one = estimate(*committed(scene), kRay, 60000, 2);
    for (int c = 0; c < 3; ++c)
      EXPECT_LT(std::abs(z_score(all, one, c)), bound(6)) << samples << " samples, channel " << c;
  }
}

// ---- Mixtures of phase functions ------------------------------------------------------------------------------------

TEST(PhaseMixture, SamplesHaveTheMeanCosineOfTheMixtureAndWeightsThatAverageToOne) {
  Scene scene;
  const float g[] = {0.7f, -0.5f, 0.1f};
  const Color sigma_s[] = {{1, 0.2f, 0}, {0, 0.5f, 3}, {0, 0, 0}};
  std::vector<Medium> media;
  for (int m = 0; m < 3; ++m) {
    media.push_back(homogeneous_box({-1, -1, 0}, {1, 1, 1}, sigma_s[m], sigma_s[m]));
    scene.media.push_back(media.back());
    scene.phases.push_back(std::make_unique<HenyeyGreenstein>(g[m]));
  }
  RecordedRay<3> r(media, ray_along_z(-1), 1);
  Arena arena;
  const ArenaScope scope(arena);
  const Vec3 incident = normalize(Vec3(1, -2, 2));
  const PhaseMixture<3> mixture(scene, incident, *r, 0, arena);
  RunningMean weight[3], cosine[3];
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const Sampler random(SamplerKind::Independent, 3, 0, i);
    const Vec3 w = mixture.sample(random.u1(Decision::PhaseLobe), random.u2(Decision::PhaseDirection));
    const float c = dot(incident, w), pdf = mixture.pdf_w(w);
    const auto value = mixture.value(w);
    for (int k = 0; k < 3; ++k)
      weight[k].add(double(value[k] / pdf)), cosine[k].add(double(value[k] / pdf) * double(c));
  }
  const double z = bound(6);
  for (int k = 0; k < 3; ++k) {
    double scattering = 0, mean = 0;
    for (int m = 0; m < 3; ++m) scattering += double(sigma_s[m][k]), mean += double(sigma_s[m][k] * g[m]);
    EXPECT_LT(std::abs(weight[k].mean() - 1), z * weight[k].standard_error() + 1e-6) << k;
    EXPECT_LT(std::abs(cosine[k].mean() - mean / scattering), z * cosine[k].standard_error() + 1e-6) << k;
  }
}

TEST(PhaseMixture, EveryLobeNumberChoosesAMediumThatScatters) {
  Scene scene;
  std::vector<Medium> media;
  for (const Color s : {Color(0), Color(2), Color(0), Color(1), Color(0)}) {
    media.push_back(homogeneous_box({-1, -1, 0}, {1, 1, 1}, s, Color(2)));
    scene.media.push_back(media.back());
    scene.phases.push_back(std::make_unique<HenyeyGreenstein>(s.r > 0 ? 0.0f : 0.999f));
  }
  RecordedRay<1> r(media, ray_along_z(-1), 1);
  Arena arena;
  const ArenaScope scope(arena);
  const PhaseMixture<1> mixture(scene, {0, 0, 1}, *r, 0, arena);
  for (const float u : {0.0f, 0.3f, 0.66666f, 0.66667f, 0.9f, 0x1.fffffep-1f}) {
    const Vec3 w = mixture.sample(u, {0.9f, 0.4f});
    EXPECT_NEAR(mixture.value(w)[0] / mixture.pdf_w(w), 1, 1e-6) << "u = " << u;
    EXPECT_LT(w.z, 0) << "u = " << u << " chose a medium that does not scatter";
  }
}

}  // namespace
}  // namespace brume
