// The real window. Tests named RealWindow need a display: CTest runs them through xvfb-run.
#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>

#include "app/gl/texture.h"
#include "app/ui/item_recorder.h"
#include "app/ui/widgets.h"
#include "app/window/glfw_window.h"

namespace brume {
namespace {

class RealWindow : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::getenv("DISPLAY")) GTEST_SKIP() << "no display";
    open({.vsync = false});
    ImGui::GetIO().UserData = &recorder_;
  }

  void open(const WindowOptions& options) {
    window_.reset();
    // Xvfb without -noreset starts anew when its last client has left, and for a moment refuses everybody.
    for (int attempt = 0; !window_ && attempt < 50; ++attempt) {
      if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
      Result<std::unique_ptr<Window>> window = Window::create("Brume test", 640, 400, options);
      if (window)
        window_ = std::move(window).value();
      else if (attempt == 49)
        FAIL() << window.error().message;
    }
  }

  // The recorder is on our side; the mouse is that of the X server.
  bool run(const std::function<void()>& widgets, int frames) {
    for (int i = 0; i < frames; ++i) {
      window_->wait_or_poll(false);
      const bool open = window_->frame([&](const Gl&) {
        ImGui::SetNextWindowPos({10, 10});
        ImGui::SetNextWindowSize({400, 300});
        ui::begin_window("Panel");
        widgets();
        ui::end_window();
      });
      if (!open) return false;
    }
    return true;
  }

  ui::ItemRecorder recorder_;
  std::unique_ptr<Window> window_;
};

bool shell(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

TEST(Window, SaysInOneSentenceThatThereIsNoDisplay) {
  if (display_available()) GTEST_SKIP() << "there is one";
  const Result<std::unique_ptr<Window>> window = Window::create("Brume test", 640, 400);
  ASSERT_FALSE(window.ok());
  EXPECT_NE(window.error().message.find("display"), std::string::npos) << window.error().message;
  EXPECT_EQ(window.error().message.find('\n'), std::string::npos);
}

TEST_F(RealWindow, DrawsAndClosesOnRequest) {
  EXPECT_TRUE(run([] { ui::button("hello"); }, 5));
  EXPECT_GT(window_->pixel_width(), 0);
  EXPECT_GT(window_->scale(), 0);
  window_->request_close();
  EXPECT_FALSE(run([] {}, 1));
}

TEST_F(RealWindow, ClosingCanBeRefused) {
  bool unsaved = true;
  int asked = 0;
  window_->on_close([&] {
    ++asked;
    return !unsaved;
  });
  window_->request_close();
  EXPECT_TRUE(run([] {}, 2));
  unsaved = false;
  window_->request_close();
  EXPECT_FALSE(run([] {}, 1));
  EXPECT_EQ(asked, 2);
}

TEST_F(RealWindow, ClipboardKeepsText) {
  window_->set_clipboard("σ = 0.5");
  EXPECT_EQ(window_->clipboard(), "σ = 0.5");
}

TEST_F(RealWindow, WakeEndsANap) {
  run([] {}, 3);
  const auto nap = [&] {
    const auto start = std::chrono::steady_clock::now();
    window_->wait_or_poll(true);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double longest = 0;
  // The events of a new window keep it awake for a while first.
  for (int i = 0; i < 100 && longest < 0.09; ++i) longest = std::max(longest, nap());
  EXPECT_GT(longest, 0.09);
  std::thread waker([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    window_->wake();
  });
  EXPECT_LT(nap(), 0.09);
  waker.join();
}

TEST_F(RealWindow, ASecondWindowAfterTheFirst) {
  EXPECT_TRUE(run([] {}, 2));
  open({.scale = 2});
  EXPECT_TRUE(display_available());
  EXPECT_EQ(window_->scale(), 2);
  EXPECT_TRUE(run([] { ui::button("again"); }, 3));
}

TEST_F(RealWindow, TakesMouseAndKeyboardOfTheDisplay) {
  if (!shell("command -v xdotool")) GTEST_SKIP() << "no xdotool";
  bool on = false;
  double value = 0;
  const auto widgets = [&] {
    ui::checkbox("on", on);
    ui::input_double("value", value);
  };
  ASSERT_TRUE(run(widgets, 10));
  const auto click = [&](const char* label) {
    const ui::ItemRecord* item = recorder_.find(label);
    const auto x = std::to_string(static_cast<int>(item->rect.center().x));
    const auto y = std::to_string(static_cast<int>(item->rect.center().y));
    // Moved first, and held for a moment, as a hand does.
    ASSERT_TRUE(shell("xdotool search --sync --name 'Brume test' windowfocus mousemove --window %1 " + x + " " + y));
    run(widgets, 5);
    ASSERT_TRUE(shell("xdotool mousedown 1"));
    run(widgets, 5);
    ASSERT_TRUE(shell("xdotool mouseup 1"));
    run(widgets, 5);
  };
  click("Panel/on");
  EXPECT_TRUE(on);
  click("Panel/value");
  ASSERT_TRUE(shell("xdotool key ctrl+a"));
  run(widgets, 5);
  ASSERT_TRUE(shell("xdotool type 2.5"));
  run(widgets, 10);
  ASSERT_TRUE(shell("xdotool key Return"));
  run(widgets, 10);
  EXPECT_EQ(value, 2.5);
}

}  // namespace
}  // namespace brume
