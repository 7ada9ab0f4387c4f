#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "renderer/experiments/sweep_chart.h"
#include "renderer/film/image_io.h"
#include "tests/ui/app_fixture.h"

namespace brume {
namespace {

class ChartPanelTest : public AppFixture {
 protected:
  /// Frames until every picture was measured at least so often.
  bool measured(std::size_t rows_each) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (std::chrono::steady_clock::now() < deadline) {
      robot().frames(1);
      std::vector<std::size_t> rows(session().shown().size());
      const auto sweep = session().errors();
      for (const SweepRow& r : sweep->rows) ++rows[r.variant];
      if (!rows.empty() && *std::min_element(rows.begin(), rows.end()) >= rows_each) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  std::string path(const std::string& name) const { return testing::TempDir() + "brume_chart_" + name; }
  static std::string content(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void with_two_variants() {
    start(scene_path("smoke.json"), kEndless, 1280, 800);
    session().change([](Node& d) {
      static_cast<void>(set_by_path(d, "compare.reference_time", "3600").ok());
      static_cast<void>(set_by_path(d, "render.bounces", "0").ok());
    });
    robot().press_key(ui::Key::V);
    robot().frames(2);
    session().change([](Node& d) { set_in_variant(d, 1, "render.step_size", "0.4"); });
    settle();
  }
  /// Two variants, both measured, and nothing more is rendered.
  void with_a_still_chart() {
    with_two_variants();
    robot().press_key(ui::Key::C);
    ASSERT_TRUE(measured(2));
    session().set_paused(true);
    robot().frames(30);
  }
};

TEST_F(ChartPanelTest, ErrorsAreMeasuredWhileTheChartIsOpenAgainstAReferenceRenderedBeside) {
  with_two_variants();
  robot().frames(20);
  EXPECT_TRUE(session().errors()->rows.empty()) << "nobody asked";
  robot().press_key(ui::Key::C);
  robot().frames(2);
  EXPECT_TRUE(robot().exists("Chart/chart"));
  ASSERT_TRUE(measured(3));
  const auto sweep = session().errors();
  ASSERT_EQ(sweep->variants.size(), 2u);
  EXPECT_EQ(sweep->variants[0].name, "A");
  for (const SweepRow& row : sweep->rows) {
    EXPECT_GT(row.errors.rmse, 0);
    EXPECT_GT(row.reference_variance, 0);
    EXPECT_GT(row.cpu_seconds, 0);
  }
  // Errors fall while samples are added.
  const auto rmse_of = [&](std::size_t variant, bool last) {
    double rmse = 0;
    for (const SweepRow& row : sweep->rows)
      if (row.variant == variant && (rmse == 0 || last)) rmse = row.errors.rmse;
    return rmse;
  };
  EXPECT_LT(rmse_of(0, true), rmse_of(0, false));
  robot().press_key(ui::Key::C);
  robot().frames(3);
  EXPECT_FALSE(session().truth().reference()) << "closed: nothing more is rendered for it";
}

TEST_F(ChartPanelTest, AnEditOfOneVariantKeepsTheErrorsOfTheOther) {
  with_a_still_chart();
  const auto before = session().errors();
  session().change([](Node& d) { set_in_variant(d, 1, "render.step_size", "0.3"); });
  for (int i = 0; i < 3000 && session().errors()->scenes == before->scenes; ++i) {
    robot().frames(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto after = session().errors();
  std::size_t of_a = 0, of_b = 0, of_a_before = 0;
  for (const SweepRow& row : before->rows) of_a_before += row.variant == 0;
  for (const SweepRow& row : after->rows) ++(row.variant == 0 ? of_a : of_b);
  EXPECT_GE(of_a, of_a_before);
  EXPECT_EQ(of_b, 0u);
}

TEST_F(ChartPanelTest, TheDifferenceFromTheReferenceIsShownOfOneSceneToo) {
  start(scene_path("smoke.json"), kEndless, 900, 700);
  EXPECT_FALSE(session().truth().wanted());
  robot().press_key(ui::Key::D, {.shift = true});
  robot().frames(2);
  EXPECT_TRUE(session().truth().wanted());
  const auto middle = [&] {
    const auto* item = robot().last_drawn("View/picture");
    const auto pixels = stage_->pixels();
    const auto at = (static_cast<std::size_t>(item->rect.center().y) * static_cast<std::size_t>(stage_->width()) +
                     static_cast<std::size_t>(item->rect.center().x)) *
                    4;
    return std::array<int, 3>{pixels[at], pixels[at + 1], pixels[at + 2]};
  };
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (!session().truth().reference() && std::chrono::steady_clock::now() < deadline) robot().frames(1);
  ASSERT_TRUE(session().truth().reference());
  session().set_paused(true);
  robot().frames(30);
  // Signed differences are blue or red, never the smoke's grey.
  int colourful = 0;
  for (int i = 0; i < 8; ++i) {
    robot().frames(1);
    const auto c = middle();
    colourful += std::abs(c[0] - c[2]) > 20 || c[0] + c[1] + c[2] < 60;
  }
  EXPECT_EQ(colourful, 8);
  robot().press_key(ui::Key::S);
  robot().frames(3);
  EXPECT_FALSE(session().truth().wanted()) << "nobody looks at it any more";
}

TEST_F(ChartPanelTest, WhatIsExportedIsWhatIsSeen) {
  with_a_still_chart();
  ASSERT_TRUE(done(robot().click("Chart/Cheapest")));
  EXPECT_TRUE(robot().exists("Chart/Apply best"));
  ChartPanel panel;
  for (const char* kind : {".svg", ".png", ".csv"}) {
    const auto done = panel.write(session(), path(std::string("out") + kind));
    EXPECT_TRUE(done.ok()) << kind;
  }
  robot().frames(1);  // the window's own contexts are current again
  const std::string svg = content(path("out.svg"));
  EXPECT_NE(svg.find(">A<"), std::string::npos);
  EXPECT_NE(svg.find(">B<"), std::string::npos);
  EXPECT_TRUE(read_png(path("out.png")).ok());
  EXPECT_EQ(content(path("out.csv")), csv_of(*session().errors()));
  EXPECT_FALSE(panel.write(session(), path("out.gif")).ok());
}

TEST_F(ChartPanelTest, TheBestVariantsSettingsAreGivenToTheScene) {
  with_a_still_chart();
  ASSERT_TRUE(done(robot().click("Chart/Cheapest")));
  const auto sweep = session().errors();
  const auto best = best_row(*sweep, *find_sweep_axis("rmse_net"), {});
  ASSERT_TRUE(best);
  ASSERT_TRUE(done(robot().click("Chart/Apply best")));
  const bool long_steps = sweep->rows[*best].variant == 1;
  EXPECT_EQ(render().is_auto("step_size"), !long_steps);
  EXPECT_EQ(session().description().child("compare").list("variants").size(), 2u) << "what is compared stays";
}

TEST_F(ChartPanelTest, ASearchFindsSettingsThatAClickApplies) {
  start(scene_path("smoke.json"), kEndless, 1280, 800);
  robot().press_key(ui::Key::C);
  robot().frames(2);
  ASSERT_TRUE(done(robot().click("Chart/Search...")));
  ASSERT_TRUE(robot().exists("Chart/Stop"));
  ASSERT_TRUE(done(robot().click("Chart/Stop")));
  const auto wait = [&] {
    for (int i = 0; i < 20000 && session().search().progress(); ++i) {
      robot().frames(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  };
  wait();
  EXPECT_FALSE(session().search().found()) << "it was given up";
  EXPECT_EQ(session().search().problem(), "");

  session().search_settings(0.005);
  wait();
  robot().frames(2);
  const auto found = session().search().found();
  ASSERT_TRUE(found);
  // Four modes x four steps x four numbers of light samples, three that march, three that do not.
  EXPECT_EQ(found->variants.size(), 64u + 3 * 4 + 3);
  ASSERT_TRUE(robot().exists("Chart/Found"));
  const auto best = best_row(*found, *find_sweep_axis("rmse_net"), {});
  ASSERT_TRUE(best);
  const Node settings = found->variants[found->rows[*best].variant].description;
  ASSERT_TRUE(done(robot().click("Chart/Apply best")));
  EXPECT_EQ(render().kind(), settings.child("render").kind());
  EXPECT_EQ(render(), settings.child("render"));
  ASSERT_TRUE(done(robot().click("Chart/Found")));
  EXPECT_FALSE(robot().exists("Chart/Apply best")) << "what is rendered is seen again";
}

}  // namespace
}  // namespace brume
