#include "app/cli/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "app/cli/console.h"

namespace brume {
namespace {

// Global because a signal handler is handed nothing but the signal's number.
std::atomic<bool> interrupted = false;
std::atomic<bool> say_so = false;
static_assert(std::atomic<bool>::is_always_lock_free);

constexpr int kSignals[] = {SIGINT, SIGTERM};

void on_signal(int) {
  interrupted = true;
  if (say_so) {
    constexpr char kText[] = "\nbrume: finishing this pass; Ctrl+C again quits at once\n";
    static_cast<void>(!write(STDERR_FILENO, kText, sizeof kText - 1));  // nothing can be done when it fails
  }
  for (int signal : kSignals) std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  interrupted = false;
  say_so = stderr_is_terminal();
  for (int signal : kSignals) {
    // A program started in the background of a script has SIGINT ignored, and shall go on ignoring it.
    if (std::signal(signal, on_signal) == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

InterruptGuard::~InterruptGuard() {
  for (int signal : kSignals)
    if (std::signal(signal, SIG_DFL) == SIG_IGN) std::signal(signal, SIG_IGN);
}

bool InterruptGuard::requested() { return interrupted; }

}  // namespace brume
