#include "stream_target.h"

#include <poll.h>
#include <spdlog/spdlog.h>
#include <unistd.h>
#include <zmq.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>

#include "stereomotion/core/output_error.h"
#include "stream_socket.h"

namespace stereomotion::app {
namespace {

class StdoutTarget : public StreamTarget {
 public:
  StdoutTarget(const std::string& hello, std::chrono::milliseconds patience) : patience_(patience) {
    std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away must not end the measuring
    Write(hello);
  }
  void Write(const std::string& line) override {
    Idle();
    if (!alive_ || HasPending()) {
      ++lost_;
      return;
    }
    rest_ = line;
    sent_ = 0;
    Idle();
  }
  void Idle() override {
    while (HasPending() && SendSome()) {
    }
  }
  [[nodiscard]] bool HasPending() const override { return alive_ && sent_ < rest_.size(); }
  [[nodiscard]] std::int64_t lost() const override { return lost_; }

 private:
  // A pipe that is ready takes PIPE_BUF bytes without waiting. False: not now.
  bool SendSome() {
    pollfd waiting{STDOUT_FILENO, POLLOUT, 0};
    const int at_most = is_read_ ? static_cast<int>(patience_.count()) : 0;
    is_read_ = poll(&waiting, 1, at_most) > 0;  // who did not read is not waited for again
    if (!is_read_) return false;
    const std::size_t size = std::min<std::size_t>(rest_.size() - sent_, PIPE_BUF);
    const ssize_t n = write(STDOUT_FILENO, rest_.data() + sent_, size);
    if (n > 0) sent_ += static_cast<std::size_t>(n);
    if (n < 0 && errno != EINTR && errno != EAGAIN) {
      alive_ = false;
      spdlog::warn("--stream -: nobody reads any more ({}); measuring goes on",
                   std::strerror(errno));
    }
    return n > 0;
  }

  std::chrono::milliseconds patience_;
  std::string rest_;
  std::size_t sent_ = 0;
  bool alive_ = true, is_read_ = true;
  std::int64_t lost_ = 0;
};

// Datagrams: whoever listens gets them; nobody is noticed.
class UdpTarget : public StreamTarget {
 public:
  explicit UdpTarget(Descriptor socket) : socket_(std::move(socket)) {}
  void Write(const std::string& line) override {
    const ssize_t n = send(socket_.get(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    const bool nobody_there = n < 0 && errno == ECONNREFUSED;
    if (n < 0 && !nobody_there) ++lost_;
  }
  [[nodiscard]] bool RepeatsHello() const override { return true; }
  [[nodiscard]] std::int64_t lost() const override { return lost_; }

 private:
  Descriptor socket_;
  std::int64_t lost_ = 0;
};

class ZeroMqTarget : public StreamTarget {
 public:
  explicit ZeroMqTarget(const StreamAddress& address)
      : context_(zmq_ctx_new()), socket_(zmq_socket(context_, ZMQ_PUB)) {
    constexpr int kLinger_ms = 1000;  // at the end so long for what was sent last
    zmq_setsockopt(socket_, ZMQ_LINGER, &kLinger_ms, sizeof kLinger_ms);
    if (zmq_bind(socket_, address.endpoint.c_str()) == 0) return;
    const std::string reason = zmq_strerror(zmq_errno());
    Close();
    throw OutputError("--stream " + address.text + ": cannot bind " + address.endpoint + ": " +
                      reason +
                      "; expected a ZeroMQ endpoint of this machine that is free (an address, "
                      "no name as localhost), as zmq+tcp://127.0.0.1:5556 or zmq:ipc:///tmp/poses");
  }
  ~ZeroMqTarget() override { Close(); }
  ZeroMqTarget(const ZeroMqTarget&) = delete;
  ZeroMqTarget& operator=(const ZeroMqTarget&) = delete;
  void Write(const std::string& line) override {
    if (zmq_send(socket_, line.data(), line.size(), ZMQ_DONTWAIT) < 0) ++lost_;
  }
  [[nodiscard]] bool RepeatsHello() const override { return true; }
  [[nodiscard]] std::int64_t lost() const override { return lost_; }

 private:
  void Close() {
    zmq_close(socket_);
    zmq_ctx_term(context_);
  }
  void* context_;
  void* socket_;
  std::int64_t lost_ = 0;
};

}  // namespace

std::unique_ptr<StreamTarget> OpenStdoutTarget(const std::string& hello,
                                               std::chrono::milliseconds patience) {
  return std::make_unique<StdoutTarget>(hello, patience);
}

std::unique_ptr<StreamTarget> OpenUdpTarget(const StreamAddress& address,
                                            const std::string& hello) {
  auto target = std::make_unique<UdpTarget>(
      OpenSocket(address, SOCK_DGRAM, "cannot send there", [](int fd, const addrinfo& place) {
        const int on = 1;  // a broadcast address is a good place, too
        setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
        return connect(fd, place.ai_addr, place.ai_addrlen);
      }));
  if (!hello.empty()) target->Write(hello);
  return target;
}

std::unique_ptr<StreamTarget> OpenZeroMqTarget(const StreamAddress& address,
                                               const std::string& hello) {
  auto target = std::make_unique<ZeroMqTarget>(address);
  if (!hello.empty()) target->Write(hello);
  return target;
}

std::unique_ptr<StreamTarget> OpenStreamTarget(const StreamAddress& address,
                                               const std::string& hello,
                                               std::chrono::milliseconds patience) {
  switch (address.kind) {
    case StreamKind::kStdout:
      return OpenStdoutTarget(hello, patience);
    case StreamKind::kTcp:
      return OpenTcpTarget(address, hello, patience);
    case StreamKind::kUdp:
      return OpenUdpTarget(address, hello);
    case StreamKind::kZeroMq:
      break;
  }
  return OpenZeroMqTarget(address, hello);
}

}  // namespace stereomotion::app
