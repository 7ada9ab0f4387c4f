#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "renderer/film/image_io.h"
#include "tests/cli/program.h"

namespace brume {
namespace {

using Json = nlohmann::json;

class RenderCommand : public ProgramTest {
 protected:
  Outcome render(const std::string& output, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"render", "scene.json", "-o", output});
    return run(more);
  }
  Image exr(const std::string& name) const {
    const auto file = read_exr(path(name));
    EXPECT_TRUE(file.ok()) << file.error().to_string();
    return file ? file->image : Image();
  }
  void expect_render_refused(std::vector<std::string> more, const std::string& text) const {
    more.insert(more.begin(), {"render", "scene.json"});
    expect_refused(more, text);
  }
};

TEST_F(RenderCommand, WritesExrWithTheSceneInside) {
  const Outcome o = render("a.exr", {"--spp", "2", "--set", "render.bounces=3"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_TRUE(o.err.starts_with("brume: wrote a.exr: 32x24, 2 samples per pixel in ")) << o.err;
  EXPECT_EQ(o.err.find('\n'), o.err.size() - 1) << "no progress bar without a terminal";
  const auto file = read_exr(path("a.exr"));
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->image.width, 32);
  EXPECT_EQ(file->image.height, 24);
  EXPECT_GT(file->image.at(16, 12).r, 0.0f);
  EXPECT_NE(file->metadata.scene_json.find("\"bounces\": 3"), std::string::npos) << file->metadata.scene_json;
  EXPECT_EQ(file->metadata.extra.at("samples_per_pixel"), "2");
}

TEST_F(RenderCommand, APngRendersToTheSamePictureAgain) {
  ASSERT_EQ(render("a.png", {"--spp", "3", "--seed", "5", "--size", "20x10", "--set", "film.exposure=1", "--set",
                             "film.curve=filmic"})
                .exit_code,
            0);
  const Outcome again = run({"render", "a.png", "-o", "b.png", "--spp", "3"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto a = read_png(path("a.png")), b = read_png(path("b.png"));
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->image.width, 20);
  EXPECT_EQ(a->image, b->image);
  // And through linear values.
  ASSERT_EQ(run({"render", "a.png", "-o", "c.EXR", "--spp", "3"}).exit_code, 0);
  ASSERT_EQ(run({"render", "c.EXR", "-o", "d.png", "--spp", "3"}).exit_code, 0);
  const auto d = read_png(path("d.png"));
  ASSERT_TRUE(d.ok());
  EXPECT_EQ(a->image, d->image);
}

TEST_F(RenderCommand, AForeignPictureHasNoScene) {
  ASSERT_TRUE(write_png(path("plain.png"), Image8(4, 4, 3)).ok());
  expect_refused({"render", "plain.png", "-o", "a.png"}, "without a scene");
}

TEST_F(RenderCommand, ExposureShowsInPngOnly) {
  for (const char* name : {"a.png", "a.exr"}) ASSERT_EQ(render(name, {"--spp", "1"}).exit_code, 0);
  for (const char* name : {"b.png", "b.exr"})
    ASSERT_EQ(render(name, {"--spp", "1", "--set", "film.exposure=1"}).exit_code, 0);
  EXPECT_EQ(exr("a.exr"), exr("b.exr"));
  const auto a = read_png(path("a.png")), b = read_png(path("b.png"));
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_GT(*b->image.at(16, 12), *a->image.at(16, 12));
}

TEST_F(RenderCommand, BitsDependOnTheSeedAndNotOnThreads) {
  ASSERT_EQ(render("one.exr", {"--spp", "3", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(render("two.exr", {"--spp", "3", "--threads", "2"}).exit_code, 0);
  ASSERT_EQ(render("seven.exr", {"--spp", "3", "--threads", "7"}).exit_code, 0);
  ASSERT_EQ(render("again.exr", {"--spp", "3", "--seed", "0"}).exit_code, 0);
  ASSERT_EQ(render("other.exr", {"--spp", "3", "--seed", "1"}).exit_code, 0);
  EXPECT_EQ(exr("one.exr"), exr("two.exr"));
  EXPECT_EQ(exr("one.exr"), exr("seven.exr"));
  EXPECT_EQ(exr("one.exr"), exr("again.exr"));
  EXPECT_NE(exr("one.exr"), exr("other.exr"));
}

TEST_F(RenderCommand, StatisticsHaveTheirKeys) {
  ASSERT_EQ(render("a.exr", {"--spp", "4", "--threads", "2", "--stats", "s.json"}).exit_code, 0);
  const Json s = Json::parse(content_of(path("s.json")));
  for (const char* key : {"samples_per_pixel",
                          "wall_seconds",
                          "cpu_seconds",
                          "rays",
                          "shadow_rays",
                          "lookups",
                          "segments",
                          "pool_high_water_bytes",
                          "non_finite_samples",
                          "capped_rays",
                          "threads",
                          "simd_level",
                          "noise",
                          "needs",
                          "step_size",
                          "shadow_step_size",
                          "warnings",
                          "grid_bytes",
                          "seed",
                          "width",
                          "height",
                          "integrator",
                          "interrupted"})
    EXPECT_TRUE(s.contains(key)) << key;
  EXPECT_EQ(s["samples_per_pixel"], 4);
  EXPECT_EQ(s["threads"], 2);
  EXPECT_EQ(s["non_finite_samples"], 0);
  EXPECT_GE(s["rays"].get<int>(), 32 * 24 * 4);
  EXPECT_GT(s["shadow_rays"].get<int>(), 0);
  EXPECT_GT(s["cpu_seconds"].get<double>(), 0.0);
  EXPECT_GT(s["pool_high_water_bytes"].get<int>(), 0);
  EXPECT_EQ(s["interrupted"], false);
}

TEST_F(RenderCommand, TimeIsABudget) {
  ASSERT_EQ(render("a.exr", {"--time", "0.3", "--stats", "s.json"}).exit_code, 0);
  const Json s = Json::parse(content_of(path("s.json")));
  EXPECT_GE(s["samples_per_pixel"].get<int>(), 1);
  // The last pass ends within half a pass of the budget.
  const double pass = s["wall_seconds"].get<double>() / s["samples_per_pixel"].get<int>();
  EXPECT_GE(s["wall_seconds"].get<double>(), 0.3 - pass);
}

TEST_F(RenderCommand, WrongValuesAreRefused) {
  const auto refuse = [&](const std::vector<std::string>& flags, const std::string& text) {
    std::vector<std::string> all{"-o", "a.png"};
    all.insert(all.end(), flags.begin(), flags.end());
    expect_render_refused(all, text);
    EXPECT_FALSE(exists("a.png"));
  };
  refuse({"--spp", "0"}, "--spp: found \"0\"");
  refuse({"--spp", "-3"}, "--spp: found \"-3\"");
  refuse({"--spp", "1e9"}, "--spp");
  refuse({"--spp", "2.5"}, "--spp");
  refuse({"--spp", "abc"}, "a whole number");
  refuse({"--time", "0"}, "--time");
  refuse({"--time", "-1"}, "--time");
  refuse({"--time", "inf"}, "--time");
  refuse({"--spp", "4", "--time", "1"}, "--spp");
  refuse({"--size", "0x10"}, "--size: found \"0x10\"");
  refuse({"--size", "10"}, "--size");
  refuse({"--size", "10x"}, "--size");
  refuse({"--size", "1.5x2"}, "--size");
  refuse({"--size", "99999x99999"}, "--size");
  refuse({"--size", "16384x16384"}, "film.resolution");  // allowed by itself, but no reader takes such a picture
  refuse({"--threads", "0"}, "--threads");
  refuse({"--threads", "100000"}, "--threads");
  refuse({"--seed", "-1"}, "--seed");
  refuse({"--seed", "x"}, "--seed");
}

TEST_F(RenderCommand, OutputsAreCheckedBeforeAnythingElse) {
  const std::string many = "4096";  // takes long enough to be noticed, but ends
  expect_render_refused({"-o", "a.jpg", "--spp", many}, "expected .exr or .png");
  expect_render_refused({"-o", "picture", "--spp", many}, "expected .exr or .png");
  expect_render_refused({"-o", "no/such/a.png", "--spp", many}, "no/such/a.png: ");
  std::filesystem::create_directory(path("folder.png"));
  expect_render_refused({"-o", "folder.png", "--spp", many}, "folder.png: ");
  expect_render_refused({"-o", "a.png", "--stats", "no/such/s.json", "--spp", many}, "no/such/s.json: ");
  expect_render_refused({"-o", "a.png", "--stats", "./a.png", "--spp", many}, "--stats: ");
  expect_render_refused({"-o", "/proc/a.png", "--spp", many}, "/proc/a.png: ");
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(RenderCommand, AFailedRunLeavesThePreviousPicture) {
  put_file(path("a.png"), "precious");
  expect_render_refused({"-o", "a.png", "--set", "render.bounces=x"}, "--set render.bounces");
  EXPECT_EQ(content_of(path("a.png")), "precious");
  // A disk that fills up while the picture is written.
  const Outcome full =
      Child({"render", "scene.json", "-o", "a.png", "--spp", "1", "--size", "200x200"}, path("."), rlim_t{1000}).wait();
  EXPECT_EQ(full.exit_code, 2) << full.err;
  EXPECT_TRUE(full.error_says("a.png: ")) << full.err;
  EXPECT_EQ(content_of(path("a.png")), "precious");
  for (const auto& entry : std::filesystem::directory_iterator(path(".")))
    EXPECT_NE(entry.path().extension(), ".tmp") << entry.path();
}

TEST_F(RenderCommand, BrokenInputsAreRefused) {
  std::filesystem::create_directory(path("folder"));
  expect_refused({"render", "folder", "-o", "a.png"}, "folder");
  std::filesystem::create_directory(path("folder.vdb"));
  expect_refused({"render", "folder.vdb", "-o", "a.png"}, "folder.vdb");
  put_file(path("empty.json"), "");
  expect_refused({"render", "empty.json", "-o", "a.png"}, "empty.json");
  put_file(path("broken.json"), "{\"brume\": 1,\n  \"camera\": {\"positon\": [0, 0, 0]}}");
  expect_refused({"render", "broken.json", "-o", "a.png"}, "broken.json:2:14: ");
  expect_refused({"render", "broken.json", "-o", "a.png"}, "did you mean position?");
  const std::string smoke = content_of(BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb");
  ASSERT_GT(smoke.size(), 1000u);
  put_file(path("cut.vdb"), smoke.substr(0, smoke.size() / 2));
  expect_refused({"render", "cut.vdb", "-o", "a.png"}, "cut.vdb");
  put_file(path("text.vdb"), "this is no grid");
  expect_refused({"render", "text.vdb", "-o", "a.png"}, "text.vdb");
  put_file(path("cut.png"), "\x89PNG\r\n\x1a\n");
  expect_refused({"render", "cut.png", "-o", "a.png"}, "cut.png");
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(RenderCommand, AGridFileIsASceneToo) {
  const Outcome o = run({"render", BRUME_SOURCE_DIR "/scenes/vdb/smoke_plume_96_f050.vdb", "-o", "a.exr", "--spp", "1",
                         "--size", "32x24", "--stats", "s.json"});
  ASSERT_EQ(o.exit_code, 0) << o.err;
  EXPECT_TRUE(o.error_says("density")) << "says what it has chosen: " << o.err;
  double sum = 0;
  for (const Color& c : exr("a.exr").pixels) sum += c.r;
  EXPECT_GT(sum, 1.0);
  const Json s = Json::parse(content_of(path("s.json")));
  EXPECT_GT(s["lookups"].get<int>(), 0);
  EXPECT_GT(s["grid_bytes"].get<int>(), 0);
}

TEST_F(RenderCommand, ABlackPictureIsExplained) {
  const Outcome o =
      render("a.png", {"--spp", "1", "--set", "lights.sun.enabled=false", "--set", "lights.lamp.enabled=false"});
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_TRUE(o.error_says("brume: warning: the picture is black. No light")) << o.err;
}

TEST_F(RenderCommand, CtrlCSavesWhatThereIs) {
  const Child child({"render", "scene.json", "-o", "a.exr", "--spp", "16777216", "--stats", "s.json"}, path("."));
  for (int i = 0; i < 3000 && !child.handles(SIGINT); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  kill(child.pid(), SIGINT);
  const Outcome o = child.wait();
  EXPECT_EQ(o.exit_code, 130) << o.err;
  EXPECT_TRUE(o.error_says("interrupted; wrote a.exr")) << o.err;
  EXPECT_EQ(exr("a.exr").width, 32);
  const Json s = Json::parse(content_of(path("s.json")));
  EXPECT_EQ(s["interrupted"], true);
  EXPECT_GE(s["samples_per_pixel"].get<int>(), 1);
}

}  // namespace
}  // namespace brume
