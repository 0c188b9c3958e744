#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "stream_address.h"

namespace stereomotion::app {

/// Sends lines to where they are wanted. All calls from one thread. A receiver that does not keep
/// up loses whole lines; no line is ever sent in part, but where the program ends.
class StreamTarget {
 public:
  virtual ~StreamTarget() = default;
  /// Sends a line; waits no longer than the target's patience.
  virtual void Write(const std::string& line) = 0;
  /// Is called while there is nothing to send: takes in new receivers, sends what waits.
  virtual void Idle() {}
  /// Tells whether something still waits to be sent.
  [[nodiscard]] virtual bool HasPending() const { return false; }
  /// Tells whether anybody receives, as far as that can be known.
  [[nodiscard]] virtual bool HasReceiver() const { return true; }
  /// Tells whether receivers may come without being noticed, so that the first line has to be
  /// repeated for them.
  [[nodiscard]] virtual bool RepeatsHello() const { return false; }
  /// Counts lines that a receiver did not get.
  [[nodiscard]] virtual std::int64_t lost() const { return 0; }
};

/// Opens a target; `hello` is the line that each receiver gets first, `patience` how long a full
/// receiver may be waited for. An empty hello is
/// not sent. Throws `OutputError` where the address cannot be used.
std::unique_ptr<StreamTarget> OpenStreamTarget(const StreamAddress& address,
                                               const std::string& hello,
                                               std::chrono::milliseconds patience);

/// The same, of each kind.
std::unique_ptr<StreamTarget> OpenStdoutTarget(const std::string& hello,
                                               std::chrono::milliseconds patience);
std::unique_ptr<StreamTarget> OpenTcpTarget(const StreamAddress& address, const std::string& hello,
                                            std::chrono::milliseconds patience);
std::unique_ptr<StreamTarget> OpenUdpTarget(const StreamAddress& address, const std::string& hello);
std::unique_ptr<StreamTarget> OpenZeroMqTarget(const StreamAddress& address,
                                               const std::string& hello);

}  // namespace stereomotion::app
