// The real application loop without a display: a stage, a session, the main window, and a robot in front of it.
#pragma once

#include <chrono>
#include <filesystem>
#include <thread>

#include "app/panels/main_window.h"
#include "app/ui/ui_fonts.h"
#include "tests/ui/robot_fixture.h"

namespace brume {

inline std::string scene_path(const std::string& name) { return std::string(BRUME_SOURCE_DIR) + "/scenes/" + name; }

class AppFixture : public testing::Test {
 protected:
  static constexpr int kEndless = 1 << 20;  ///< samples: the picture never finishes

  /// @param scene  file to open, or empty
  void start(const std::string& scene, int samples = 2, int width = 1280, int height = 800) {
    samples_ = samples;
    auto stage = Stage::create({.width = width, .height = height, .font_paths = ui_font_paths()});
    ASSERT_TRUE(stage.ok()) << stage.error().message;
    stage_ = std::move(stage).value();
    session_ = std::make_unique<Session>(SessionOptions{.threads = 2, .max_samples = samples, .on_news = {}});
    if (!scene.empty()) session_->open(scene);
    window_ = std::make_unique<MainWindow>(*session_, stage_->gl(), MainWindowOptions{.measured = false});
    robot_ = std::make_unique<Robot>(*stage_, [this](const Gl&) { window_->draw(); });
    settle();
  }

  void TearDown() override {
    robot_.reset();
    if (stage_) stage_->make_current();
    window_.reset();  // its texture belongs to the stage's context
    session_.reset();
    stage_.reset();
  }

  /// Frames until the newest edit's picture has all its samples and has been drawn.
  void settle() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (std::chrono::steady_clock::now() < deadline) {
      robot_->frames(1);
      if (finished()) {
        robot_->frames(2);
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    FAIL() << "no finished picture after two minutes; problem: " << session_->problem();
  }

  bool finished() const {
    if (!session_->idle()) return false;
    if (!session_->scene()) return true;  // nothing to render, or nothing that can be
    if (!session_->problem().empty()) return true;
    if (samples_ != kEndless) return session_->finished();
    if (!session_->up_to_date()) return false;
    for (std::size_t i = 0; i < session_->shown().size(); ++i)
      if (session_->picture(i)->preview) return false;
    return true;
  }

  /// Mean of all channels of the picture that is shown.
  double brightness() const {
    const auto picture = session_->picture();
    double sum = 0;
    for (const Color& c : picture->image.pixels) sum += static_cast<double>(mean(c));
    return sum / static_cast<double>(picture->image.pixels.size());
  }

  Robot& robot() { return *robot_; }
  Session& session() { return *session_; }
  const Node& render() { return session_->description().child("render"); }
  const Node& camera() { return session_->description().child("camera"); }

  int samples_ = 0;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<MainWindow> window_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace brume
