#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "stream_socket.h"
#include "stream_target.h"

namespace stereomotion::app {
namespace {

/// So much waits for a slow client; beyond, it loses lines: some seconds of one body at 200 Hz.
constexpr std::size_t kMostPendingBytes = 1 << 20;

/// One client: what it has not taken yet is kept, whole lines.
class Client {
 public:
  explicit Client(Descriptor socket) : socket_(std::move(socket)) {
    const int on = 1;  // a line is worth a packet: it is to come now
    setsockopt(socket_.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  [[nodiscard]] bool alive() const { return alive_; }
  [[nodiscard]] bool HasPending() const { return alive_ && sent_ < pending_.size(); }
  [[nodiscard]] bool HasRoomFor(const std::string& line) const {
    return pending_.size() - sent_ + line.size() <= kMostPendingBytes;
  }
  void Append(const std::string& line) {
    pending_.erase(0, sent_);
    sent_ = 0;
    pending_ += line;
  }
  void Flush() {
    while (HasPending()) {
      const ssize_t n = send(socket_.get(), pending_.data() + sent_, pending_.size() - sent_,
                             MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n > 0) {
        sent_ += static_cast<std::size_t>(n);
      } else if (errno != EINTR) {
        alive_ = errno == EAGAIN || errno == EWOULDBLOCK;
        return;
      }
    }
  }
  // Once it took nothing for so long, it is not waited for again.
  void WaitUntilWritable(std::chrono::milliseconds at_most) {
    pollfd waiting{socket_.get(), POLLOUT, 0};
    is_read_ = poll(&waiting, 1, is_read_ ? static_cast<int>(at_most.count()) : 0) > 0;
    Flush();
  }

 private:
  Descriptor socket_;
  std::string pending_;
  std::size_t sent_ = 0;
  bool alive_ = true, is_read_ = true;
};

class TcpTarget : public StreamTarget {
 public:
  TcpTarget(Descriptor listener, std::string hello, std::chrono::milliseconds patience)
      : listener_(std::move(listener)), hello_(std::move(hello)), patience_(patience) {}

  void Write(const std::string& line) override {
    Idle();
    for (Client& client : clients_) WriteTo(client, line);
    ForgetDead();
  }
  void Idle() override {
    while (true) {
      Descriptor socket(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
      if (!socket.ok()) break;
      clients_.emplace_back(std::move(socket));
      clients_.back().Append(hello_);
    }
    for (Client& client : clients_) client.Flush();
    ForgetDead();
  }
  [[nodiscard]] bool HasPending() const override {
    return std::any_of(clients_.begin(), clients_.end(),
                       [](const Client& client) { return client.HasPending(); });
  }
  [[nodiscard]] bool HasReceiver() const override { return !clients_.empty(); }
  [[nodiscard]] std::int64_t lost() const override { return lost_; }

 private:
  void WriteTo(Client& client, const std::string& line) {
    if (!client.HasRoomFor(line)) client.WaitUntilWritable(patience_);
    if (client.HasRoomFor(line)) {
      client.Append(line);
    } else {
      ++lost_;
    }
    client.Flush();
  }
  void ForgetDead() {
    clients_.erase(std::remove_if(clients_.begin(), clients_.end(),
                                  [](const Client& client) { return !client.alive(); }),
                   clients_.end());
  }

  Descriptor listener_;
  std::string hello_;
  std::chrono::milliseconds patience_;
  std::vector<Client> clients_;
  std::int64_t lost_ = 0;
};

}  // namespace

std::unique_ptr<StreamTarget> OpenTcpTarget(const StreamAddress& address, const std::string& hello,
                                            std::chrono::milliseconds patience) {
  Descriptor listener =
      OpenSocket(address, SOCK_STREAM, "cannot listen there", [](int fd, const addrinfo& place) {
        const int on = 1;  // a run that follows another at once finds the port free
        setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        const int failed = bind(fd, place.ai_addr, place.ai_addrlen);
        return failed != 0 ? failed : listen(fd, SOMAXCONN);
      });
  return std::make_unique<TcpTarget>(std::move(listener), hello, patience);
}

}  // namespace stereomotion::app
