#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace brume {
namespace {

using Json = nlohmann::json;

class ProbeCommand : public ProgramTest {
 protected:
  Json probe(std::vector<std::string> flags) const {
    flags.insert(flags.begin(), {"probe", "scene.json"});
    const Outcome o = run(flags);
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_EQ(o.err, "");
    return Json::parse(o.out, nullptr, false);
  }
};

constexpr double kSigma = 0.5, kAlbedo = 0.8;  // of the scene
constexpr double kPi64 = 3.14159265358979323846;

TEST_F(ProbeCommand, AgreesWithTheClosedFormOfAHomogeneousBox) {
  const Json j = probe(
      {"--ray=-3,0,0,1,0,0", "--samples", "4096", "--set", "render.bounces=0", "--set", "lights.lamp.enabled=false"});
  // Two units of medium on the ray; one above every point of it, towards the sun.
  const double irradiance[3] = {3, 2, 1};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(j["transmittance"][c].get<double>(), std::exp(-2 * kSigma), 1e-6);
    EXPECT_NEAR(j["optical_depth"][c].get<double>(), 2 * kSigma, 1e-6);
    const double expected = kAlbedo / (4 * kPi64) * irradiance[c] * std::exp(-kSigma) * (1 - std::exp(-2 * kSigma));
    const double error = j["radiance"]["standard_error"][c].get<double>();
    EXPECT_LT(error, 0.003 * expected);
    EXPECT_NEAR(j["radiance"]["mean"][c].get<double>(), expected, 5 * error + 1e-5 * expected);
  }
  EXPECT_EQ(j["segments"], 1.0);
  EXPECT_EQ(j["lookups"], 0.0);
  EXPECT_EQ(j["samples"], 4096);
  EXPECT_EQ(j["non_finite"], 0);
  EXPECT_TRUE(j["seconds"].is_number());
}

TEST_F(ProbeCommand, TminAndTmaxCutTheRay) {
  // The medium lies at t in [2, 4].
  const auto transmittance = [&](std::vector<std::string> flags) {
    flags.insert(flags.begin(), {"--ray=-3,0,0,1,0,0", "--samples", "2"});
    return probe(flags)["transmittance"][0].get<double>();
  };
  EXPECT_NEAR(transmittance({"--tmax", "3"}), std::exp(-kSigma), 1e-6);
  EXPECT_NEAR(transmittance({"--tmin", "3.5"}), std::exp(-0.5 * kSigma), 1e-6);
  EXPECT_NEAR(transmittance({"--tmin", "2.5", "--tmax", "3.5"}), std::exp(-kSigma), 1e-6);
  EXPECT_EQ(transmittance({"--tmax", "1"}), 1.0);
}

TEST_F(ProbeCommand, TheDirectionIsNormalised) {
  for (const char* ray : {"--ray=-3,0,0,1e-30,0,0", "--ray=-3,0,0,25,0,0", "--ray=-3,0,0,1e30,0,0"}) {
    const Json j = probe({ray, "--samples", "2", "--tmax", "3"});
    EXPECT_NEAR(j["transmittance"][0].get<double>(), std::exp(-kSigma), 1e-6) << ray;
    EXPECT_EQ(j["ray"]["direction"][0], 1.0);
  }
  // The value may stand apart, though it begins like a flag.
  EXPECT_NEAR(probe({"--ray", "-3,0,0,1,0,0", "--samples", "2"})["transmittance"][0].get<double>(),
              std::exp(-2 * kSigma), 1e-6);
}

TEST_F(ProbeCommand, TechniquesAgreeWithinTheirStandardErrors) {
  const std::vector<std::string> common{"--ray=-3,0.2,0.1,1,0,0", "--samples", "65536", "--set",
                                        "lights.sun.enabled=false"};
  const auto measure = [&](const std::string& technique, const std::string& seed) {
    auto flags = common;
    flags.insert(flags.end(), {"--set", "render.distance_sampling=" + technique, "--seed", seed});
    const Json j = probe(flags);
    return std::pair(j["radiance"]["mean"][0].get<double>(), j["radiance"]["standard_error"][0].get<double>());
  };
  // With one light sample the techniques of MIS alternate: the error must be that of pairs.
  const auto [mis, mis_error] = measure("mis", "1");
  const auto [density, density_error] = measure("density", "2");
  const auto [equi_angular, equi_angular_error] = measure("equi_angular", "3");
  EXPECT_GT(mis, 0.0);
  EXPECT_GT(mis_error, 0.0);
  EXPECT_NEAR(mis, density, 5 * std::hypot(mis_error, density_error) + 1e-5 * mis);
  EXPECT_NEAR(mis, equi_angular, 5 * std::hypot(mis_error, equi_angular_error) + 1e-5 * mis);
}

TEST_F(ProbeCommand, TheStandardErrorIsThatOfRepetition) {
  // 16 runs of 1024 samples: their scatter is the standard error each of them claims. The variance of 16 numbers has a
  // relative standard deviation of sqrt(2/15) = 0.37; a factor of 2.5 in the error is 6.25 in the variance.
  double sum = 0, sum2 = 0, claimed = 0;
  constexpr int kRuns = 16;
  for (int i = 0; i < kRuns; ++i) {
    const Json j = probe({"--ray=-3,0.2,0.1,1,0,0", "--samples", "1024", "--seed", std::to_string(i)});
    const double mean = j["radiance"]["mean"][0].get<double>();
    sum += mean, sum2 += mean * mean;
    claimed += j["radiance"]["standard_error"][0].get<double>() / kRuns;
  }
  const double scatter = std::sqrt((sum2 - sum * sum / kRuns) / (kRuns - 1));
  EXPECT_LT(scatter, 2.5 * claimed);
  EXPECT_GT(scatter, claimed / 2.5);
}

TEST_F(ProbeCommand, TheSamplerIsIndependentWhateverTheSceneSays) {
  const auto mean = [&](const std::string& sampler) {
    return probe({"--ray=-3,0,0,1,0,0", "--samples", "64", "--set", "render.sampler=" + sampler})["radiance"];
  };
  EXPECT_EQ(mean("sobol"), mean("independent"));
}

TEST_F(ProbeCommand, BitsDependOnTheSeedAndNotOnThreads) {
  const auto radiance = [&](const std::string& threads, const std::string& seed) {
    return probe({"--ray=-3,0.2,0.1,1,0,0", "--samples", "3000", "--threads", threads, "--seed", seed})["radiance"];
  };
  EXPECT_EQ(radiance("1", "0"), radiance("2", "0"));
  EXPECT_EQ(radiance("1", "0"), radiance("7", "0"));
  EXPECT_NE(radiance("1", "0"), radiance("1", "1"));
}

TEST_F(ProbeCommand, ARayThatMeetsNothingIsClear) {
  const Json j = probe({"--ray=-3,5,0,1,0,0", "--samples", "1"});
  EXPECT_EQ(j["samples"], 2);  // pairs
  EXPECT_EQ(j["transmittance"], (Json{1.0, 1.0, 1.0}));
  EXPECT_EQ(j["optical_depth"], (Json{0.0, 0.0, 0.0}));
  EXPECT_EQ(j["radiance"]["mean"], (Json{0.0, 0.0, 0.0}));
  EXPECT_EQ(j["segments"], 0.0);
}

TEST_F(ProbeCommand, AScenesFarFromTheOriginIsProbedInItsOwnSpace) {
  const Json j = probe({"--ray=9999997,10000000,10000000,1,0,0", "--samples", "2", "--set",
                        "volumes.fog.transform.translate=1e7,1e7,1e7"});
  EXPECT_NEAR(j["transmittance"][0].get<double>(), std::exp(-2 * kSigma), 1e-6);
}

TEST_F(ProbeCommand, WrongRaysAreRefused) {
  const auto refuse = [&](const std::vector<std::string>& flags, const std::string& text) {
    std::vector<std::string> all{"probe", "scene.json"};
    all.insert(all.end(), flags.begin(), flags.end());
    expect_refused(all, text);
  };
  refuse({"--ray=0,0,0,0,0,0"}, "--ray: found the direction 0,0,0");
  refuse({"--ray=0,0,0,0,1"}, "--ray: found \"0,0,0,0,1\"");
  refuse({"--ray=0,0,0,0,1,x"}, "six numbers");
  refuse({"--ray=0,0,0,0,nan,1"}, "six numbers");
  refuse({"--ray=0,0,0,0,inf,1"}, "six numbers");
  refuse({"--ray="}, "--ray");
  refuse({"--ray=1e30,0,0,0,0,1"}, "--ray");
  refuse({"--ray=0,0,0,0,0,1", "--samples", "0"}, "--samples");
  refuse({"--ray=0,0,0,0,0,1", "--tmin", "3", "--tmax", "3"}, "--tmax");
  refuse({"--ray=0,0,0,0,0,1", "--tmin", "-1"}, "--tmin");
}

}  // namespace
}  // namespace brume
