#pragma once

#include <atomic>

namespace stereomotion::app {

/// Makes SIGINT and SIGTERM set the returned flag; a second one ends the program at once.
const std::atomic<bool>& CatchStopSignals();

}  // namespace stereomotion::app
