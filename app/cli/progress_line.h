// A progress bar for people who wait at a terminal.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace brume {

/// What a bar shows: "rendering [======>      ] 7/16 samples  noise 1.3 %", with the time and an estimate of the rest.
struct ProgressState {
  double fraction = 0;     ///< done, in [0, 1]
  std::string done = {};   ///< "7/16 samples"
  std::string extra = {};  ///< "noise 1.3 %"
};

/// One line at the bottom of the terminal, redrawn in place ten times a second by a thread of its own, so that the time
/// goes on while a long pass is under way. It appears after half a second: short work needs none. Does nothing when
/// stderr is no terminal. The line is gone when the object ends.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Any thread.
  void update(ProgressState state);

 private:
  using Clock = std::chrono::steady_clock;

  void draw(const std::stop_token& stop);
  std::string text() const;

  const std::string what_;
  const Clock::time_point start_ = Clock::now();
  mutable std::mutex mutex_;  // guards the next two
  ProgressState state_;
  double seconds_left_ = -1;  // at updated_; negative: unknown
  Clock::time_point updated_ = start_;
  std::condition_variable_any ticked_;
  std::jthread thread_;  // last: it ends before what it uses
};

/// "0.016 s", "4.2 s", "3 min 20 s", "2 h 5 min"
std::string format_duration(double seconds);

}  // namespace brume
