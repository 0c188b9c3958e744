#pragma once

#include <string>

namespace stereomotion::app {

/// Names the ways in which poses leave the program.
enum class StreamKind { kStdout, kTcp, kUdp, kZeroMq };

/// Says where --stream sends poses to.
struct StreamAddress {
  StreamKind kind = StreamKind::kStdout;
  std::string text;        ///< as the user gave it
  std::string host, port;  ///< TCP, UDP; host "*": every address of this machine
  std::string endpoint;    ///< ZeroMQ: "tcp://*:5556", "ipc:///tmp/poses"
};

/// Reads "-", "tcp://HOST:PORT", "udp://HOST:PORT", "zmq+tcp://HOST:PORT" or "zmq:ENDPOINT"; an
/// IPv6 address in brackets. Throws `UserError`.
StreamAddress ParseStreamAddress(const std::string& text);

}  // namespace stereomotion::app
