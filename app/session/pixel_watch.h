// One pixel, probed again and again as its picture gets better.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "renderer/experiments/pixel_probe.h"

namespace brume {

/// Works in a thread of its own; all functions: any thread, without waiting for a probe.
class PixelWatch {
 public:
  /// @param on_news  called from that thread when there is a new probe; must not block
  explicit PixelWatch(std::function<void()> on_news = {});
  ~PixelWatch();

  /// As often as one likes; the newest wish counts, and one that is hardly different from what is known is none. A
  /// scene that is null wishes nothing.
  /// @param samples  of the picture; so many are looked at, up to a thousand
  void want(std::shared_ptr<const Scene> scene, const PixelPlace& place, int samples);

  /// The newest of the scene and the place that were wanted last; null before it.
  std::shared_ptr<const PixelProbe> probe() const;

 private:
  struct Wish {
    std::shared_ptr<const Scene> scene = nullptr;
    PixelPlace place = {};
    int samples = 0;
  };

  void serve(const std::stop_token& stop);

  std::function<void()> on_news_;
  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable_any wished_;
  Wish wish_;               // the newest
  bool is_served_ = true;   // it has been taken up
  std::stop_source stale_;  // what is under way is of another scene or place
  std::shared_ptr<const PixelProbe> probe_;
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace brume
