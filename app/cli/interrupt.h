// Ctrl+C as a wish to stop, not as an accident.
#pragma once

namespace brume {

/// While it lives, the first Ctrl+C (SIGINT) or SIGTERM is only noted, so that work done so far can be saved; the
/// second one ends the program at once. One at a time, on the main thread.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether one has come. Any thread.
  static bool requested();
};

}  // namespace brume
