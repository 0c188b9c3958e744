#include "stream_address.h"

#include <charconv>

#include "stereomotion/core/user_error.h"

namespace stereomotion::app {
namespace {

[[noreturn]] void Refuse(const std::string& text, const std::string& what) {
  throw UserError("--stream: found '" + text + "'" + what +
                  ", expected -, tcp://HOST:PORT, udp://HOST:PORT, zmq+tcp://HOST:PORT or "
                  "zmq:ENDPOINT, for example tcp://127.0.0.1:5555");
}

bool TakeStart(const std::string& start, std::string& text) {
  if (text.rfind(start, 0) != 0) return false;
  text.erase(0, start.size());
  return true;
}

void CheckPort(const std::string& whole, const std::string& port) {
  constexpr int kHighestPort = 65535;
  int number = 0;
  const char* const end = port.data() + port.size();
  const auto [stop, error] = std::from_chars(port.data(), end, number);
  if (error == std::errc() && stop == end && number >= 1 && number <= kHighestPort) return;
  Refuse(whole, " with the port '" + port + "' (a number from 1 to 65535)");
}

void SplitHostAndPort(const std::string& rest, StreamAddress& address) {
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos) Refuse(address.text, " without a port");
  address.host = rest.substr(0, colon);
  address.port = rest.substr(colon + 1);
  if (address.host.empty()) Refuse(address.text, " without a host");
  CheckPort(address.text, address.port);
  std::string& host = address.host;
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  if (!bracketed && host.find(':') != std::string::npos) {
    Refuse(address.text, " (IPv6 addresses need brackets)");
  }
}

}  // namespace

StreamAddress ParseStreamAddress(const std::string& text) {
  StreamAddress address;
  address.text = text;
  std::string rest = text;
  if (text == "-") return address;
  if (TakeStart("tcp://", rest) || TakeStart("udp://", rest)) {
    address.kind = text.front() == 't' ? StreamKind::kTcp : StreamKind::kUdp;
    SplitHostAndPort(rest, address);
    return address;
  }
  address.kind = StreamKind::kZeroMq;
  if (TakeStart("zmq+tcp://", rest)) {
    SplitHostAndPort(rest, address);
    address.endpoint = "tcp://" + rest;
    return address;
  }
  if (!TakeStart("zmq:", rest) || rest.find("://") == std::string::npos) Refuse(text, "");
  address.endpoint = rest;
  return address;
}

}  // namespace stereomotion::app
