// Receivers that do not keep up, on a TCP stream of the loopback.

#include "apps/pose_stream.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "apps/stream_socket.h"
#include "stereomotion/core/output_error.h"

namespace stereomotion::app {
namespace {

// A port that was free a moment ago.
int FreePort() {
  const Descriptor probe(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(bind(probe.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  socklen_t size = sizeof place;
  getsockname(probe.get(), reinterpret_cast<sockaddr*>(&place), &size);
  return ntohs(place.sin_port);
}

Descriptor Connect(int port) {
  Descriptor client(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  EXPECT_EQ(connect(client.get(), reinterpret_cast<sockaddr*>(&place), sizeof place), 0);
  return client;
}

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t start = 0;
  for (std::size_t end = 0; (end = text.find('\n', start)) != std::string::npos; start = end + 1) {
    lines.push_back(text.substr(start, end - start));
  }
  EXPECT_EQ(start, text.size()) << "the last line is torn: " << text.substr(start);
  return lines;
}

// Reads up to the line that says why the stream ended.
std::vector<std::string> ReadUntilEnd(const Descriptor& client) {
  std::string text;
  std::string some(1 << 16, '\0');
  while (text.find("{\"end\"") == std::string::npos) {
    const ssize_t n = read(client.get(), some.data(), some.size());
    if (n <= 0) break;
    text.append(some, 0, static_cast<std::size_t>(n));
  }
  return Split(text);
}

std::int64_t FrameOf(const std::string& line) {
  const std::string key = "{\"frame\":";
  return line.rfind(key, 0) == 0 ? std::stoll(line.substr(key.size())) : -1;
}

PoseEstimate SomePose() {
  PoseEstimate pose;
  pose.world_from_body.translation_mm = {1.0 / 3, 2.0 / 3, 1000.0 / 3};
  pose.covariance.setConstant(1e-7 / 3);
  return pose;
}

class LiveStream {
 public:
  explicit LiveStream(const std::string& address)
      : stream_(address, {{"l", "r"}, {"body"}, true}) {}
  PoseStream& operator*() { return stream_; }
  void Tell(std::int64_t frame) {
    PromptPose prompt;
    prompt.frame = frame;
    prompt.status = PoseStatus::kOk;
    prompt.pose = &pose_;
    stream_.Tell(prompt, 12.5);
  }

 private:
  PoseEstimate pose_ = SomePose();
  PoseStream stream_;
};

TEST(PoseStream, WhoReadsGetsEveryLineInOrder) {
  const int port = FreePort();
  LiveStream stream("tcp://127.0.0.1:" + std::to_string(port));
  const Descriptor client = Connect(port);
  std::thread teller([&] {
    const std::atomic<bool> never{false};
    (*stream).AwaitReceiver(never);
    for (int i = 0; i < 500; ++i) {
      stream.Tell(i);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    (*stream).End("count");
  });
  const std::vector<std::string> lines = ReadUntilEnd(client);
  teller.join();
  EXPECT_EQ((*stream).lost_lines(), 0);
  ASSERT_EQ(lines.size(), 502U);
  for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
    EXPECT_EQ(FrameOf(lines[i]), static_cast<std::int64_t>(i) - 1);
  }
}

/// 60 MB for a client that reads nothing: more than every buffer on the way.
TEST(PoseStream, WhoDoesNotReadLosesWholeLinesAndHoldsNobodyUp) {
  constexpr std::int64_t kLines = 60000;
  const int port = FreePort();
  LiveStream stream("tcp://127.0.0.1:" + std::to_string(port));
  const Descriptor client = Connect(port);
  const std::atomic<bool> never{false};
  (*stream).AwaitReceiver(never);
  const auto start = std::chrono::steady_clock::now();
  for (std::int64_t i = 0; i < kLines; ++i) {
    stream.Tell(i);
    if (i % 500 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  std::vector<std::string> lines;
  std::thread reader([&] { lines = ReadUntilEnd(client); });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // now it reads: there is room again
  (*stream).End("count");
  reader.join();
  const std::int64_t lost = (*stream).lost_lines();
  EXPECT_GT(lost, 0);
  ASSERT_GT(lines.size(), 100U);
  EXPECT_NE(lines.front().find("stereomotion-stream/1"), std::string::npos);
  std::int64_t last = -1;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].back(), '}');
    if (lines[i].find("\"end\"") != std::string::npos) continue;
    ASSERT_GT(FrameOf(lines[i]), last) << lines[i];
    last = FrameOf(lines[i]);
  }
}

TEST(PoseStream, TwoProgramsOnOnePort) {
  const std::string address = "tcp://127.0.0.1:" + std::to_string(FreePort());
  const LiveStream first(address);
  EXPECT_THROW(LiveStream second(address), OutputError);
}

TEST(StreamLines, NumbersAreWholeAndTextsAreQuoted) {
  const PoseEstimate pose = SomePose();
  PromptPose prompt;
  prompt.frame = 3;
  prompt.timestamp_ns = 123456789012345678;
  prompt.status = PoseStatus::kOk;
  prompt.pose = &pose;
  std::string line;
  PoseLine(prompt, "a \"b\"\n", 1.25, line);
  EXPECT_NE(line.find(R"("body":"a \"b\"\u000a")"), std::string::npos) << line;
  EXPECT_NE(line.find(R"("timestamp_ns":123456789012345678)"), std::string::npos);
  EXPECT_NE(line.find("[0.3333333333333333,0.6666666666666666,333.3333333333333]"),
            std::string::npos);
  EXPECT_NE(line.find(R"("latency_ms":1.25})"), std::string::npos);
  prompt.pose = nullptr;
  prompt.status = PoseStatus::kDropped;
  PoseLine(prompt, "body", std::nullopt, line);
  EXPECT_EQ(line,
            "{\"frame\":3,\"timestamp_ns\":123456789012345678,\"body\":\"body\",\"status\":"
            "\"dropped\"}\n");
}

}  // namespace
}  // namespace stereomotion::app
