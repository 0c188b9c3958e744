#pragma once

#include <atomic>

namespace stereomotion::app {

/// Makes SIGINT, SIGTERM and SIGHUP (the terminal was closed; not where `nohup` ignores it) set the
/// returned flag; a second one ends the program at once.
const std::atomic<bool>& CatchStopSignals();

}  // namespace stereomotion::app
