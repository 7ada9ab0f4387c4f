#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <thread>

#include "renderer/film/image_io.h"
#include "tests/cli/program.h"

namespace brume {
namespace {

/// A scene small enough to be charted in a second; references are kept in the test's own folder.
class ChartCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    setenv("XDG_CACHE_HOME", path("cache").c_str(), 1);
    put_file(path("scene.json"), R"({"brume": 1, "film": {"resolution": [24, 16]},
      "camera": {"position": [0, -4, 0.5], "look_at": [0, 0, 0]},
      "render": {"bounces": 1},
      "volumes": [{"shader": "gaussian", "density_scale": 4}],
      "lights": [{"type": "point", "position": [2, -1, 2], "intensity": [8, 8, 8]}],
      "compare": {"variants": [{"name": "plain"}, {"name": "long", "set": {"render.step_size": 0.5}}]}})");
  }
  void TearDown() override {
    unsetenv("XDG_CACHE_HOME");
    ProgramTest::TearDown();
  }

  Outcome chart(std::vector<std::string> more) {
    std::vector<std::string> words{"chart", "scene.json", "--budget", "0.05", "--reference-time", "0.1"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }

  std::vector<std::vector<std::string>> rows(const std::string& name) const {
    std::vector<std::vector<std::string>> all;
    std::istringstream csv(content_of(path(name)));
    for (std::string line; std::getline(csv, line);) {
      all.emplace_back();
      bool quoted = false;
      std::string cell;
      for (const char c : line) {
        quoted ^= c == '"';
        if (c != ',' || quoted) {
          if (c != '"') cell += c;
          continue;
        }
        all.back().push_back(cell);
        cell.clear();
      }
      all.back().push_back(cell);
    }
    return all;
  }
};

TEST_F(ChartCommand, ChartsTheVariantsOfTheSceneInAllThreeFormats) {
  const Outcome o = chart({"-o", "a.svg", "-o", "a.png", "-o", "a.csv"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const std::string svg = content_of(path("a.svg"));
  EXPECT_NE(svg.find(">plain<"), std::string::npos);
  EXPECT_NE(svg.find(">long<"), std::string::npos);
  EXPECT_NE(svg.find("CPU time"), std::string::npos);
  const auto png = read_png(path("a.png"));
  ASSERT_TRUE(png.ok());
  EXPECT_EQ(png->image.width, 960);
  const auto table = rows("a.csv");
  ASSERT_GT(table.size(), 4u);
  const std::vector<std::string> first{"variant", "integrator",    "distance_sampling", "step_size",
                                       "bounces", "light_samples", "samples_per_pixel", "cpu_seconds",
                                       "rmse",    "relative_mse",  "mean_bias"};
  EXPECT_TRUE(std::equal(first.begin(), first.end(), table[0].begin()));
  EXPECT_EQ(table[1][0], "plain");
  EXPECT_EQ(table.back()[0], "long");
  EXPECT_EQ(table.back()[3], "0.5");
  EXPECT_EQ(table.back()[4], "1");
  for (std::size_t i = 1; i < table.size(); ++i) {
    EXPECT_EQ(table[i].size(), table[0].size());
    EXPECT_GT(std::stod(table[i][7]), 0);
    EXPECT_GT(std::stod(table[i][8]), 0);
  }
  EXPECT_NE(o.out.find("plain"), std::string::npos) << "a summary for the person";
}

TEST_F(ChartCommand, SweepsMethodsStepsAndBounces) {
  const Outcome o = chart({"--methods", "product,ray_march,delta_tracking", "--steps", "0.1,0.4", "--bounces", "0,2",
                           "--spp", "1", "-o", "a.csv", "-o", "cost.svg", "--x", "steps", "--y", "seconds_per_sample"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const auto table = rows("a.csv");
  ASSERT_EQ(table.size(), 1u + (2 + 2 + 1) * 2);
  EXPECT_EQ(table[1][0], "product, step_size 0.1, bounces 0");
  EXPECT_NE(content_of(path("cost.svg")).find("product: n^"), std::string::npos) << "fitted exponents";
}

TEST_F(ChartCommand, WritesTheSceneOfTheBest) {
  const Outcome o =
      chart({"--methods", "product,ray_march_cached", "--pareto", "--apply-best", "best.json", "-o", "a.svg"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_NE(o.out.find("Best: "), std::string::npos) << o.out;
  EXPECT_EQ(run({"render", "best.json", "-o", "b.png", "--spp", "1"}).exit_code, 0);
  const Outcome far = chart({"--target", "1e-9", "-o", "b.svg"});
  EXPECT_EQ(far.exit_code, 3) << "the target is out of reach";
}

TEST_F(ChartCommand, TakesAnyPictureAsReferenceAndRefusesOneThatDoesNotFit) {
  ASSERT_TRUE(write_exr(path("truth.exr"), Image(24, 16, Color(0.1f))).ok());
  EXPECT_EQ(chart({"--reference", "truth.exr", "-o", "a.csv"}).exit_code, 0);
  EXPECT_EQ(rows("a.csv")[1].back(), "0") << "its own error is unknown";
  ASSERT_TRUE(write_exr(path("small.exr"), Image(4, 4)).ok());
  expect_refused({"chart", "scene.json", "--reference", "small.exr", "-o", "a.csv"}, "4 x 4");
  Image hole(24, 16);
  hole.at(1, 2).r = std::numeric_limits<float>::infinity();
  ASSERT_TRUE(write_exr(path("hole.exr"), hole).ok());
  expect_refused({"chart", "scene.json", "--reference", "hole.exr", "-o", "a.csv"}, "(1, 2)");
}

TEST_F(ChartCommand, CtrlCWhileTheReferenceIsMadeEndsItAndKeepsWhatThereIs) {
  const Child child({"chart", "scene.json", "-o", "a.svg", "--reference-time", "3600"}, path("."));
  for (int i = 0; i < 3000 && !child.handles(SIGINT); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  kill(child.pid(), SIGINT);
  const Outcome o = child.wait();
  EXPECT_EQ(o.exit_code, 130) << o.err;
  EXPECT_FALSE(std::filesystem::exists(path("a.svg")));
  EXPECT_FALSE(std::filesystem::is_empty(path("cache/brume/references")));
}

TEST_F(ChartCommand, RefusesWhatItDoesNotKnow) {
  expect_refused({"chart", "scene.json", "-o", "a.gif"}, ".svg or .png or .csv");
  expect_refused({"chart", "scene.json", "-o", "a.svg", "--methods", "produkt"}, "did you mean product");
  expect_refused({"chart", "scene.json", "-o", "a.svg", "--variants", "plai"}, "did you mean plain");
  expect_refused({"chart", "scene.json", "-o", "a.svg", "--x", "time"}, "unknown quantity");
  expect_refused({"chart", "scene.json", "-o", "a.svg", "--steps", "0.1,-1"}, "greater than 0");
  expect_refused({"chart", "scene.json", "-o", "a.svg", "--pareto", "--x", "steps"}, "cpu_seconds");
}

}  // namespace
}  // namespace brume
