// A stage with one window "Panel" and a robot in front of it.
#pragma once

#include <gtest/gtest.h>
#include <imgui.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "app/headless/robot.h"
#include "app/ui/widgets.h"

namespace brume {

inline testing::AssertionResult done(const Result<void>& result) {
  return result.ok() ? testing::AssertionSuccess() : testing::AssertionFailure() << result.error().message;
}

inline testing::AssertionResult fails_with(const Result<void>& result, const std::string& words) {
  if (result.ok()) return testing::AssertionFailure() << "it succeeded";
  if (result.error().message.find(words) == std::string::npos)
    return testing::AssertionFailure() << result.error().message;
  return testing::AssertionSuccess();
}

inline void place(float x, float y, float width, float height) {
  ImGui::SetNextWindowPos({x, y}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({width, height}, ImGuiCond_Appearing);
}

class RobotFixture : public testing::Test {
 protected:
  // `widgets` draws inside the window; it has to outlive the robot, and so do its variables.
  void show(const std::function<void()>& widgets, float height = 500) {
    if (!stage_) {
      auto stage = Stage::create({.width = 640, .height = 600});
      ASSERT_TRUE(stage.ok()) << stage.error().message;
      stage_ = std::move(stage).value();
    }
    robot_ = std::make_unique<Robot>(*stage_, [=](const Gl&) {
      place(20, 20, 400, height);
      ui::begin_window("Panel");
      widgets();
      ui::end_window();
    });
    robot_->frames(2);
  }
  Robot& robot() { return *robot_; }

  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Robot> robot_;
};

}  // namespace brume
