// Instructions that fixed pictures take: the one figure of speed that does not move with the machine.
#include <gnu/libc-version.h>
#include <gtest/gtest.h>

#include <hwy/highway.h>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/core/simd.h"
#include "tests/cli/program.h"

namespace brume {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kBaseline = BRUME_SOURCE_DIR "/tests/bench/instructions.json";
constexpr const char* kLevel = "avx2";  // Valgrind knows no wider one
constexpr int kWidth = 64, kHeight = 48;
constexpr double kTolerance = 0.03;

/// What the counts depend on besides the source.
Json surroundings() {
  const std::string highway = std::to_string(HWY_MAJOR) + "." + std::to_string(HWY_MINOR);
  return {{"compiler", __VERSION__}, {"glibc", gnu_get_libc_version()}, {"highway", highway}, {"simd_level", kLevel}};
}

/// Instructions of all calls of the integrator, for one pixel.
long instructions_per_pixel(const std::string& scene, const std::string& arguments, const std::string& folder) {
  const std::string log = folder + "/callgrind.log";
  const std::string command = std::string("BRUME_SIMD=") + kLevel + " LD_PRELOAD=" BRUME_VALGRIND_TIMER +
                              " valgrind --tool=callgrind --callgrind-out-file=/dev/null" +
                              " '--toggle-collect=brume::*Integrator::radiance(*' " BRUME_EXECUTABLE " render " +
                              BRUME_SOURCE_DIR "/scenes/" + scene + ".json -o " + folder + "/picture.exr --size " +
                              std::to_string(kWidth) + "x" + std::to_string(kHeight) + " --spp 1 --threads 1 " +
                              arguments + " > " + log + " 2>&1";
  const int status = std::system(command.c_str());
  const std::string text = content_of(log), key = "Collected : ";
  EXPECT_EQ(status, 0) << text;
  const std::size_t at = text.find(key);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0 : std::stol(text.substr(at + key.size())) / (kWidth * kHeight);
}

struct Picture {
  const char *name, *scene, *arguments;
};
constexpr Picture kPictures[] = {
    {"smoke", "smoke", ""},
    {"smoke, MIS, no bounces", "smoke", "--set render.distance_sampling=mis --set render.bounces=0"},
    {"smoke, ray_march, no bounces", "smoke", "--set render.integrator=ray_march --set render.bounces=0"},
    {"smoke, delta_tracking_local", "smoke", "--set render.integrator=delta_tracking_local"},
    {"fire", "fire", ""},
    {"cloud", "cloud", ""},
    {"fog", "fog", ""},
    {"surfaces", "surfaces", ""},
};

TEST(InstructionsSnapshot, AreThoseOfTheBaseline) {
#ifndef NDEBUG
  GTEST_SKIP() << "a debug build counts its own checks";
#endif
  if (BRUME_IS_SANITIZED) GTEST_SKIP() << "a sanitizer counts its own checks";
  const auto levels = simd_levels();
  if (std::find(levels.begin(), levels.end(), kLevel) == levels.end()) GTEST_SKIP() << "no " << kLevel << " here";

  const std::string folder = std::string(BRUME_TEST_OUTPUT_DIR) + "/instructions";
  std::filesystem::create_directories(folder);
  const bool update = std::getenv("BRUME_UPDATE_BASELINES") != nullptr;
  Json counted;
  Json baseline;
  if (!update) {
    baseline = Json::parse(content_of(kBaseline));
    if (baseline["with"] != surroundings())
      GTEST_SKIP() << "the baseline was counted with " << baseline["with"] << ", this is " << surroundings();
  }
  for (const Picture& p : kPictures) {
    const long now = instructions_per_pixel(p.scene, p.arguments, folder);
    counted[p.name] = now;
    if (update) continue;
    const double before = baseline["instructions_per_pixel"].value(p.name, 0.0);
    RecordProperty(p.name, std::to_string(now));
    EXPECT_NEAR(static_cast<double>(now) / before, 1, kTolerance)
        << p.name << ": " << now << " instructions for each pixel, " << before << " in " << kBaseline
        << "; if that is meant, tests/run --update-baselines writes it anew";
  }
  if (update && !HasFailure())
    put_file(kBaseline, Json{{"with", surroundings()}, {"instructions_per_pixel", counted}}.dump(2) + "\n");
}

}  // namespace
}  // namespace brume
