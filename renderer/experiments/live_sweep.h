// A sweep of what is being rendered in the window: measured as it comes.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "renderer/experiments/sweep.h"

namespace brume {

/// Looks at the pictures of a comparison in a thread of its own and keeps their errors: the same rows, and so the same
/// charts and tables, as those of a sweep without a window. All functions: any thread, without waiting for a
/// measurement.
class LiveSweep {
 public:
  /// @param on_rows  called from the measuring thread when there are new rows; must not block
  explicit LiveSweep(std::function<void()> on_rows = {});
  ~LiveSweep();

  /// What is rendered now. Rows of a scene that was rendered before are kept.
  void follow(std::vector<SweepVariant> variants, std::vector<std::shared_ptr<const Scene>> scenes);
  /// From now on pictures are held against this one; null: nothing is measured.
  void set_reference(std::shared_ptr<const Reference> reference);
  /// A picture of variant i, as often as one likes: it is measured when it has a quarter more samples than the last.
  void see(std::size_t variant, const std::shared_ptr<const Picture>& picture);

  /// What is known so far; its reference has no picture. Never null.
  std::shared_ptr<const Sweep> sweep() const;

 private:
  struct Look {
    std::size_t variant;
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<const Picture> picture;
  };

  void measure(const std::stop_token& stop);
  void publish(std::vector<SweepRow> rows);

  std::function<void()> on_rows_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable_any seen_;
  std::shared_ptr<const Sweep> sweep_;
  std::shared_ptr<const Reference> reference_;
  std::vector<int> samples_;  // of each variant's last look
  std::deque<Look> looks_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace brume
