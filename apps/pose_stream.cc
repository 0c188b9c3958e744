#include "pose_stream.h"

#include <spdlog/spdlog.h>

#include <chrono>

namespace stereomotion::app {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostWaiting = 1024;  // lines; five seconds of one body at 200 Hz
constexpr milliseconds kLook{50};           // so often new receivers are looked for
constexpr milliseconds kHelloEvery{1000};
constexpr milliseconds kReplayPatience{10000}, kLivePatience{0};
constexpr milliseconds kLongestEnd{2000};

milliseconds PatienceOf(const StreamAddress& address, bool live) {
  // Standard output is one reader, waited for by the stream's own thread, not by the measuring.
  constexpr milliseconds kLiveStdout{100};
  if (!live) return kReplayPatience;
  return address.kind == StreamKind::kStdout ? kLiveStdout : kLivePatience;
}

}  // namespace

PoseStream::PoseStream(const std::string& address, StreamHello hello)
    : hello_(std::move(hello)),
      address_(address),
      ring_(kMostWaiting),
      patient_(!hello_.live),
      hello_at_(Clock::now()) {
  const StreamAddress parsed = ParseStreamAddress(address);
  target_ = OpenStreamTarget(parsed, HelloLine(hello_), PatienceOf(parsed, hello_.live));
  has_receiver_ = target_->HasReceiver();
  thread_ = std::thread([this] { Work(); });
}

PoseStream::~PoseStream() {
  if (thread_.joinable()) End("failed");
}

void PoseStream::AwaitReceiver(const std::atomic<bool>& stop) const {
  if (has_receiver_) return;
  spdlog::info("--stream {}: waiting up to {} s for a receiver", address_,
               std::chrono::duration_cast<std::chrono::seconds>(kReplayPatience).count());
  const Clock::time_point until = Clock::now() + kReplayPatience;
  while (!has_receiver_ && !stop && Clock::now() < until) std::this_thread::sleep_for(kLook);
}

void PoseStream::Tell(const PromptPose& prompt, std::optional<double> latency_ms) {
  const std::string& body = hello_.bodies[static_cast<std::size_t>(prompt.body)];
  pairs_ += prompt.body == 0 ? 1 : 0;
  PoseLine(prompt, body, latency_ms, line_);
  Push(line_);
}

void PoseStream::Push(const std::string& line) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto has_room = [&] { return waiting_ < ring_.size(); };
  if (patient_ && !changed_.wait_for(lock, kReplayPatience, has_room)) {
    patient_ = false;  // a receiver that stopped reading is not waited for line by line
    spdlog::warn("--stream {}: the receiver takes nothing any more; lines are lost", address_);
  }
  if (!has_room()) {
    ++lost_;
    return;
  }
  ring_[(first_ + waiting_) % ring_.size()] = line;
  ++waiting_;
  changed_.notify_all();
}

bool PoseStream::TakeLine(std::string& line) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!changed_.wait_for(lock, kLook, [&] { return waiting_ > 0 || ended_; })) return false;
  if (waiting_ == 0) return false;
  std::swap(line, ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  --waiting_;
  changed_.notify_all();
  return true;
}

void PoseStream::RepeatHello() {
  if (!target_->RepeatsHello() || Clock::now() - hello_at_ < kHelloEvery) return;
  hello_at_ = Clock::now();
  target_->Write(HelloLine(hello_));
}

void PoseStream::Work() {
  std::string line;
  while (true) {
    RepeatHello();
    if (TakeLine(line)) {
      target_->Write(line);
    } else {
      target_->Idle();
      if (ended_) break;
    }
    has_receiver_ = target_->HasReceiver();
    target_lost_ = target_->lost();
  }
  target_->Write(EndLine(line_, pairs_, lost_lines()));
  const Clock::time_point until = Clock::now() + kLongestEnd;
  while (target_->HasPending() && Clock::now() < until) {
    std::this_thread::sleep_for(milliseconds(1));
    target_->Idle();
  }
}

void PoseStream::End(const std::string& reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    line_ = reason;  // the measuring has ended: the line is free
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (lost_lines() == 0) return;
  spdlog::warn("--stream {}: {} lines were lost: a receiver did not take them in time", address_,
               lost_lines());
}

}  // namespace stereomotion::app
