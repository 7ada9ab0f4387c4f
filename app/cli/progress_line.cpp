#include "app/cli/progress_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/cli/console.h"

namespace brume {
namespace {

constexpr auto kFirstDraw = std::chrono::milliseconds(500);
constexpr auto kRedraw = std::chrono::milliseconds(100);
constexpr int kBarCells = 16;
constexpr const char* kClearLine = "\r\x1b[K";

/// Columns that a line may take without wrapping, which would leave copies of it behind.
std::size_t terminal_columns() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 2) return 79;
  return size.ws_col - 1u;
}

double seconds_between(std::chrono::steady_clock::time_point a, std::chrono::steady_clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

std::string bar(double fraction) {
  const int full = static_cast<int>(std::clamp(fraction, 0.0, 1.0) * kBarCells);
  std::string cells(static_cast<std::size_t>(full), '=');
  cells.resize(kBarCells, ' ');
  if (full < kBarCells) cells[static_cast<std::size_t>(full)] = '>';
  return "[" + cells + "]";
}

}  // namespace

std::string format_duration(double seconds) {
  char text[64];
  if (seconds < 9.95) {
    std::snprintf(text, sizeof text, seconds < 0.95 ? "%.2g s" : "%.1f s", seconds);
    return text;
  }
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60)
    std::snprintf(text, sizeof text, "%lld s", whole);
  else if (whole < 3600)
    std::snprintf(text, sizeof text, "%lld min %lld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%lld h %lld min", whole / 3600, whole / 60 % 60);
  return text;
}

ProgressLine::ProgressLine(std::string what) : what_(std::move(what)) {
  if (stderr_is_terminal()) thread_ = std::jthread([this](const std::stop_token& stop) { draw(stop); });
}

ProgressLine::~ProgressLine() = default;

void ProgressLine::update(ProgressState state) {
  const std::lock_guard lock(mutex_);
  updated_ = Clock::now();
  const double elapsed = seconds_between(start_, updated_);
  seconds_left_ = state.fraction > 0 ? elapsed * (1 - state.fraction) / state.fraction : -1;
  state_ = std::move(state);
}

std::string ProgressLine::text() const {
  const auto now = Clock::now();
  std::string line = what_ + " " + bar(state_.fraction);
  if (!state_.done.empty()) line += " " + state_.done;
  line += "  " + format_duration(seconds_between(start_, now));
  if (seconds_left_ >= 0)
    line += ", " + format_duration(std::max(0.0, seconds_left_ - seconds_between(updated_, now))) + " left";
  if (!state_.extra.empty()) line += "  " + state_.extra;
  return line.substr(0, terminal_columns());
}

void ProgressLine::draw(const std::stop_token& stop) {
  bool drawn = false;
  std::unique_lock lock(mutex_);
  for (auto wait = kFirstDraw; !ticked_.wait_for(lock, stop, wait, [&] { return stop.stop_requested(); });
       wait = kRedraw) {
    std::fputs((kClearLine + text()).c_str(), stderr);
    drawn = true;
  }
  if (drawn) std::fputs(kClearLine, stderr);
}

}  // namespace brume
