#pragma once

#include <string>

namespace stereomotion::testing {

/// Moves this process (all children follow) into a network of its own, where 127.0.0.1 and
/// 127.0.0.2 are the only addresses, so that GigE Vision discovery stays in it. Call it before any
/// thread is started. Returns an empty text, or why it is not possible here.
std::string EnterOwnNetwork();

}  // namespace stereomotion::testing
