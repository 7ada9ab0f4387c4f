#include "renderer/experiments/sweep.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "renderer/film/image_io.h"
#include "tests/support/scenes.h"

namespace brume {
namespace {

constexpr int kWidth = 24, kHeight = 16;

Node small_scene() {
  Node scene = empty_scene();
  set(scene, "render.bounces", "1");
  set(scene, "camera.position", "0,-4,0.5");
  set(add_volume(scene, "gaussian"), "density_scale", "4");
  add_light(scene, "point");
  return scene;
}

std::vector<std::string> names(const std::vector<SweepVariant>& variants) {
  std::vector<std::string> all;
  for (const SweepVariant& v : variants) all.push_back(v.name);
  return all;
}

TEST(Sweep, AllMethodsAreEveryIntegratorAndEveryDistanceSampling) {
  const auto methods = all_methods(small_scene());
  EXPECT_EQ(methods.size(), integrator_types().size() + 3);
  for (const SweepVariant& m : methods) {
    EXPECT_EQ(m.description.child("render").integer("bounces"), 1) << m.name << " lost a setting of the scene";
    const auto& render = m.description.child("render");
    EXPECT_EQ(m.name, render.kind() == "decoupled" ? render.text("distance_sampling") : render.kind());
  }
}

TEST(Sweep, OnlyWhatHasTheParameterIsSwept) {
  auto methods = all_methods(small_scene());
  std::erase_if(methods, [](const SweepVariant& m) { return m.name != "product" && m.name != "delta_tracking"; });
  const auto variants = swept(methods, "render.step_size", {"0.1", "0.5"});
  ASSERT_TRUE(variants.ok());
  EXPECT_EQ(names(*variants),
            (std::vector<std::string>{"product, step_size 0.1", "product, step_size 0.5", "delta_tracking"}));
  EXPECT_EQ((*variants)[1].series, "product");
  EXPECT_EQ((*variants)[1].description.child("render").number("step_size"), 0.5);
  EXPECT_FALSE(swept(methods, "render.step_size", {"-1"}).ok());
  std::erase_if(methods, [](const SweepVariant& m) { return m.name == "product"; });
  EXPECT_FALSE(swept(methods, "render.step_size", {"0.1"}).ok()) << "nobody has it";
}

TEST(Sweep, MeasuresThePicturesOfSeparateRenders) {
  SceneCache cache;
  WorkerPool pool(2);
  const Node scene = small_scene();
  auto variants = all_methods(scene);
  std::erase_if(variants, [](const SweepVariant& m) { return m.name != "density" && m.name != "ray_march"; });
  Reference truth{Image(kWidth, kHeight, Color(0.25f))};
  const auto sweep = run_sweep(variants, {truth}, cache, pool,
                               {.width = kWidth, .height = kHeight, .cpu_seconds = 1e9, .max_samples = 7});
  ASSERT_TRUE(sweep.ok()) << sweep.error().to_string();
  std::vector<int> samples;
  for (const SweepRow& row : sweep->rows) {
    samples.push_back(row.samples_per_pixel);
    EXPECT_EQ(row.last, row.samples_per_pixel == 7);
    Film film(kWidth, kHeight);
    render_batch(*committed(variants[row.variant].description), row.samples_per_pixel, film, pool);
    EXPECT_EQ(row.errors.rmse, *rmse(film.mean_image(), truth.image));
    EXPECT_EQ(row.errors.mean_bias, *mean_bias(film.mean_image(), truth.image));
    EXPECT_GT(row.cpu_seconds, 0);
  }
  EXPECT_EQ(samples, (std::vector<int>{1, 2, 3, 4, 6, 7, 1, 2, 3, 4, 6, 7}));
}

TEST(Sweep, RefusesAReferenceOfAnotherSizeOrWithHoles) {
  SceneCache cache;
  WorkerPool pool(1);
  const auto run = [&](Image image) {
    return run_sweep(sweep_of({{"A", small_scene()}}), {{std::move(image)}}, cache, pool,
                     {.width = kWidth, .height = kHeight, .cpu_seconds = 1e9, .max_samples = 1});
  };
  EXPECT_FALSE(run(Image(kWidth + 1, kHeight)).ok());
  Image hole(kWidth, kHeight);
  hole.at(3, 3).g = std::numeric_limits<float>::quiet_NaN();
  const auto refused = run(hole);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("(3, 3)"), std::string::npos) << refused.error().message;
}

// ---- References -----------------------------------------------------------------------------------------------------

class ReferenceTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "brume_references_" + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Reference make(double seconds, const Node& scene = small_scene()) {
    WorkerPool pool(2);
    SceneCache cache;
    auto made = make_reference(scene, cache, pool,
                               {.width = kWidth, .height = kHeight, .cpu_seconds = seconds, .folder = folder_});
    EXPECT_TRUE(made.ok());
    return std::move(made).value();
  }
  std::size_t files() const {
    std::size_t n = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) n += entry.is_regular_file();
    return n;
  }

  std::string folder_;
};

TEST_F(ReferenceTest, IsKeptAndGoneOnWith) {
  const Reference first = make(0.05);
  EXPECT_GE(first.samples_per_pixel, 2);
  EXPECT_GE(first.cpu_seconds, 0.05);
  EXPECT_EQ(files(), 1u);
  const Reference again = make(0.05);
  EXPECT_EQ(again.image, first.image) << "there was nothing left to do";
  EXPECT_EQ(again.samples_per_pixel, first.samples_per_pixel);
  EXPECT_EQ(again.variance, first.variance);
  const Reference more = make(0.5);
  EXPECT_GT(more.samples_per_pixel, first.samples_per_pixel);
  EXPECT_LT(more.variance, first.variance);
  EXPECT_EQ(files(), 1u);
  // It is the picture of so many samples, however many times it was gone on with.
  const auto scene = committed(reference_description(small_scene()));
  WorkerPool pool(2);
  Film film(kWidth, kHeight);
  render_batch(*scene, more.samples_per_pixel, film, pool);
  EXPECT_LT(*rmse(more.image, film.mean_image()), 1e-6);
  EXPECT_NEAR(more.variance / film.mean_variance(), 1, 0.3);
}

TEST_F(ReferenceTest, ErrorsAreAsItsVarianceSays) {
  const Reference a = make(0.2);
  Node scene = reference_description(small_scene());
  set(scene, "render.seed", "12345");
  WorkerPool pool(2);
  Film film(kWidth, kHeight);
  render_batch(*committed(scene), 2000, film, pool);
  const double mse = std::pow(*rmse(a.image, film.mean_image()), 2);
  // 384 pixels of unlike noise.
  EXPECT_NEAR(mse / (a.variance + film.mean_variance()), 1, 0.4);
}

TEST_F(ReferenceTest, AnotherTruthHasAnotherKeyAndAnotherLookHasNot) {
  const Node scene = reference_description(small_scene());
  const std::string key = reference_key(scene, 10, 20);
  EXPECT_EQ(key.size(), 32u);
  EXPECT_NE(reference_key(scene, 20, 10), key);
  const auto key_with = [&](const char* path, const char* value) {
    Node other = small_scene();
    set(other, path, value);
    return reference_key(reference_description(other), 10, 20);
  };
  for (const auto& [path, value] : {std::pair{"render.bounces", "2"},
                                    {"volumes.0.density_scale", "5"},
                                    {"camera.vfov_deg", "31"},
                                    {"lights.0.intensity", "2"}})
    EXPECT_NE(key_with(path, value), key) << path;
  for (const auto& [path, value] : {std::pair{"film.exposure", "2"},
                                    {"render.step_size", "0.5"},
                                    {"render.distance_sampling", "density"},
                                    {"render.integrator", "ray_march"},
                                    {"render.seed", "9"},
                                    {"compare.share", "equal_samples"}})
    EXPECT_EQ(key_with(path, value), key) << path;
}

TEST_F(ReferenceTest, ADamagedOneIsRenderedAnew) {
  const Reference first = make(0.05);
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    std::filesystem::resize_file(entry.path(), 100);
  const Reference again = make(0.05);
  EXPECT_GE(again.samples_per_pixel, 2);
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReferenceTest, AGivenPictureMustHaveTheSizeAndBeFinite) {
  std::filesystem::create_directories(folder_);
  const std::string path = folder_ + "/given.exr";
  ASSERT_TRUE(write_exr(path, Image(4, 3, Color(1))).ok());
  EXPECT_TRUE(load_reference(path, 4, 3).ok());
  const auto wrong = load_reference(path, 5, 3);
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().source.file, path);
  EXPECT_NE(wrong.error().message.find("4 x 3"), std::string::npos) << wrong.error().message;
}

}  // namespace
}  // namespace brume
