// The bias of decoupled marching, and the power of the step with which it goes away.
//
// A march of step h looks a density f up once per segment, at one offset U in [0,1) for all of them. Over a length L of
// whole segments the optical depth it finds is, by Euler and Maclaurin with Bernoulli's polynomials B_k,
//   tau_hat(U) = h sum_i f((i + U) h) = tau + sum_{k>=1} h^k / k! B_k(U) [f^(k-1)(L) - f^(k-1)(0)].
// The mean of every B_k over U is 0: tau_hat is unbiased. Its exponential is not; with E[B_1^2] = 1/12,
//   E[exp(-sigma tau_hat)] = T (1 + sigma^2 Var(tau_hat) / 2 + ...) = T (1 + sigma^2 h^2 (f(L) - f(0))^2 / 24 +
//   O(h^4)).
// So the mean has order 2, whatever the density is inside, and order 4 where it is the same at both ends: B_1 then
// drops out, E[B_2^2] = 1/180, and the leading term is sigma^2 h^4 (f'(L) - f'(0))^2 / 1440. Single scattering keeps
// order 2: f_i T_i of a segment differ from f T at the point by terms whose means are O(h^2).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/effort.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr double kInv4PiD = 0.07957747154594766788;

/// A density of the profile shaders in the box [-1,1] x [-1,1] x [0,1], and the same in double.
struct Profile {
  const char* name;
  double sigma_t;
  std::function<Node&(Node&)> add;
  std::function<double(Vec3d)> density;
  double at_ends;        ///< f(1) - f(0) on the z axis
  double slope_at_ends;  ///< f'(1) - f'(0)
};

double gaussian(Vec3d p, double centre, double s) {
  return std::exp(-(p.x * p.x + p.y * p.y + (p.z - centre) * (p.z - centre)) / (2 * s * s));
}

Profile gaussian_profile(const char* name, double centre, double s, double sigma_t) {
  const auto f = [=](double z) { return gaussian({0, 0, z}, centre, s); };
  const auto slope = [=](double z) { return -(z - centre) / (s * s) * f(z); };
  return {name,
          sigma_t,
          [=](Node& scene) -> Node& {
            Node& v = add_volume(scene, "gaussian");
            set(v, "center", format_value(Numbers{0, 0, centre}));
            set(v, "sigma", format_value(s));
            return v;
          },
          [=](Vec3d p) { return gaussian(p, centre, s); },
          f(1) - f(0),
          slope(1) - slope(0)};
}

const std::vector<Profile>& profiles() {
  static const std::vector<Profile> all{
      {"linear", 2.5,
       [](Node& scene) -> Node& {
         Node& v = add_volume(scene, "linear");
         set(v, "gradient", "0,0,1.6");
         set(v, "offset", "0.2");
         return v;
       },
       [](Vec3d p) { return 0.2 + 1.6 * p.z; }, 1.6, 0},
      {"exponential", 5,
       [](Node& scene) -> Node& {
         Node& v = add_volume(scene, "exponential");
         set(v, "scale_height", "0.5");
         return v;
       },
       [](Vec3d p) { return std::exp(-2 * p.z); }, std::exp(-2.0) - 1, -2 * (std::exp(-2.0) - 1)},
      gaussian_profile("gaussian_off_centre", 0.375, 0.25, 5),
      gaussian_profile("gaussian", 0.5, 0.5, 10)};
  return all;
}

/// The profile, absorbing and scattering with the given albedo, at a step of 1 / steps for camera and shadow rays.
Node scene_of(const Profile& profile, double albedo, int steps) {
  Node scene = empty_scene();
  set(scene, "render.step_size", format_value(1.0 / steps));
  Node& v = profile.add(scene);
  set(v, "bounds.min", "-1,-1,0");
  set(v, "bounds.max", "1,1,1");
  set(v, "density_scale", format_value(profile.sigma_t));
  set(v, "albedo", format_value(Numbers(3, albedo)));
  return scene;
}

const Ray kUp{{0, 0, -1}, {0, 0, 1}};

/// Mean over the scrambles of as many pixels: their spread is the honest noise of low-discrepancy points.
RunningMean measured(const Node& description, int samples, int pixels = 8) {
  const auto scene = committed(description);
  RunningMean mean;
  for (int k = 0; k < pixels; ++k) mean.add(estimate(*scene, kUp, samples, 1, static_cast<std::uint32_t>(k)).mean());
  return mean;
}

/// Optical depth of a line, by quadrature.
double depth_between(const Profile& profile, Vec3d from, Vec3d to) {
  const Vec3d way = to - from;
  return profile.sigma_t * length(way) * integrate([&](double s) { return profile.density(from + way * s); }, 0, 1, 24);
}

/// Slope of log2(bias) against log2(step), by least squares; steps[k + 1] = 2 steps[k].
double fitted_order(const std::vector<double>& bias) {
  const double n = static_cast<double>(bias.size()), middle = (n - 1) / 2;
  double slope = 0, spread = 0;
  for (std::size_t k = 0; k < bias.size(); ++k) {
    const double x = middle - static_cast<double>(k);  // log2 of the step, but for a constant
    slope += x * std::log2(std::abs(bias[k]));
    spread += x * x;
  }
  return slope / spread;
}

struct Fit {
  std::vector<double> bias;  ///< relative, of every step
  double order = 0;
};

/// Bias at the steps 1/n, 1/2n, 1/4n and 1/8n. Every bias must be ten times its noise.
Fit fit(const char* what, const Profile& profile, double truth, int n, const std::function<RunningMean(int)>& measure) {
  Fit out;
  for (int steps = n; steps <= 8 * n; steps *= 2) {
    const RunningMean mean = measure(steps);
    const double bias = mean.mean() / truth - 1, noise = mean.standard_error() / truth;
    std::printf("%-20s %-14s step 1/%-3d bias %+.3e +- %.0e\n", profile.name, what, steps, bias, noise);
    EXPECT_LT(noise, 0.1 * std::abs(bias)) << profile.name << ", " << what << ": too noisy to judge at " << steps;
    out.bias.push_back(bias);
  }
  out.order = fitted_order(out.bias);
  std::printf("%-20s %-14s order %.3f\n", profile.name, what, out.order);
  return out;
}

// A tenth of noise at the last step moves the fitted slope by 0.3 * 0.1 / ln 2 = 0.04, and the next order of the
// series, some per cent of the bias at the first step, by as much again: 0.1.
constexpr double kOrderTolerance = 0.1;

TEST(Convergence, TransmittanceHasTheOrderAndTheLeadingTermOfTheSeries) {
  for (const Profile& profile : profiles()) {
    const bool same_ends = std::abs(profile.at_ends) < 1e-9;
    const double depth = depth_between(profile, {0, 0, 0}, {0, 0, 1});
    const int n = same_ends ? 2 : 4;
    const Fit found = fit("transmittance", profile, std::exp(-depth), n, [&](int steps) {
      Node scene = scene_of(profile, 0, steps);
      set(add_light(scene, "environment"), "radiance", "1,1,1");
      return measured(scene, 4096);
    });
    const double order = same_ends ? 4 : 2, h = 1.0 / (8 * n), s = profile.sigma_t;
    EXPECT_NEAR(found.order, order, kOrderTolerance) << profile.name;
    const double leading = same_ends ? s * s * std::pow(h, 4) * std::pow(profile.slope_at_ends, 2) / 1440
                                     : s * s * h * h * std::pow(profile.at_ends, 2) / 24;
    EXPECT_NEAR(found.bias.back() / leading, 1, 0.05) << profile.name << ": the finest step";
  }
}

/// Single scattering of the sun by quadrature; `towards` is the end of the shadow ray from z.
double single_scattering(const Profile& profile, double albedo, const std::function<Vec3d(double)>& towards) {
  return integrate(
      [&](double z) {
        const Vec3d x{0, 0, z};
        return albedo * profile.sigma_t * profile.density(x) * kInv4PiD *
               std::exp(-depth_between(profile, {0, 0, 0}, x) - depth_between(profile, x, towards(z)));
      },
      0, 1, 60);
}

// From a step of 1/8 on: the densest profile has an optical depth of 10 per unit.
TEST(Convergence, SingleScatteringOfASunFromTheSideAndFromBehindHasOrderTwo) {
  const int samples = (full_effort() ? 16384 : 4096) / (kFewer > 1 ? 2 : 1);  // fewer are too noisy to judge
  for (const Profile& profile : profiles())
    for (const bool from_the_side : {true, false}) {
      const double truth = single_scattering(profile, 0.8, [&](double z) {
        return from_the_side ? Vec3d{1, 0, z} : Vec3d{0, 0, 0};
      });
      const Fit found = fit(from_the_side ? "side light" : "light behind", profile, truth, 8, [&](int steps) {
        Node scene = scene_of(profile, 0.8, steps);
        set(scene, "render.light_samples", "64");
        Node& sun = add_light(scene, "directional");
        set(sun, "direction", from_the_side ? "-1,0,0" : "0,0,1");
        set(sun, "irradiance", "1,1,1");
        return measured(scene, samples);
      });
      EXPECT_NEAR(found.order, 2, kOrderTolerance) << profile.name << (from_the_side ? ", side" : ", behind");
    }
}

}  // namespace
}  // namespace brume
