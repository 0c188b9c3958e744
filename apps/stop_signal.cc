#include "stop_signal.h"

#include <csignal>

namespace stereomotion::app {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler may touch it only so");

void RequestStop(int /*signal*/) { stop_requested.store(true); }

}  // namespace

const std::atomic<bool>& CatchStopSignals() {
  struct sigaction action {};
  action.sa_handler = RequestStop;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second signal meets the default: the end
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  const bool is_ignored = (before.sa_flags & SA_SIGINFO) == 0 && before.sa_handler == SIG_IGN;
  if (!is_ignored) sigaction(SIGHUP, &action, nullptr);  // nohup: it is to go on
  return stop_requested;
}

}  // namespace stereomotion::app
