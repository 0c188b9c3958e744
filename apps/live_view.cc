#include "live_view.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>

#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/pose/status_words.h"

namespace stereomotion::app {
namespace {

constexpr std::chrono::milliseconds kRedrawEvery{200};
constexpr std::chrono::seconds kLogEvery{10};
constexpr double kLostAlarm_s = 1;
constexpr double kBytesPerGigabyte = 1e9;
/// The share that a new value has in what is shown: numbers that jump cannot be read.
constexpr double kNewShare = 0.3;

std::string PoseText(const PoseEstimate& pose) {
  const Eigen::Vector3d& t = pose.world_from_body.translation_mm;
  const Eigen::Vector3d turn =
      LogSO3(WithPositiveW(pose.world_from_body.rotation)) * kDegreesPerRadian;
  return fmt::format("{:.3f} px  at {:.2f} {:.2f} {:.2f} mm  turned {:.2f} {:.2f} {:.2f} deg",
                     pose.rms_px, t.x(), t.y(), t.z(), turn.x(), turn.y(), turn.z());
}

}  // namespace

LiveView::LiveView(const std::vector<Body>& bodies, bool quiet)
    : on_terminal_(!quiet && isatty(STDERR_FILENO) == 1), on_log_(!quiet && !on_terminal_) {
  for (const Body& body : bodies) {
    Seen& seen = bodies_.emplace_back();
    seen.name = body.name;
    seen.posed_at = Clock::now();
  }
}

void LiveView::Tell(const PromptPose& prompt, double latency_ms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pairs_ += prompt.body == 0 ? 1 : 0;
  latency_ms_ = pairs_ > 1 ? latency_ms_ + kNewShare * (latency_ms - latency_ms_) : latency_ms;
  Seen& seen = bodies_.at(static_cast<std::size_t>(prompt.body));
  seen.status = prompt.status;
  seen.detections_left = prompt.detections_left;
  seen.detections_right = prompt.detections_right;
  if (prompt.pose == nullptr) {
    seen.pose.reset();
    return;
  }
  seen.pose = *prompt.pose;
  seen.posed_at = Clock::now();
}

bool LiveView::IsDue() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::duration since = Clock::now() - shown_at_;
  return (on_terminal_ && since >= kRedrawEvery) || (on_log_ && since >= kLogEvery);
}

std::string LiveView::StreamLine(const LiveReport& report, Clock::time_point now) {
  const double seconds = std::chrono::duration<double>(now - shown_at_).count();
  const std::int64_t pairs = bodies_.empty() ? report.pairs : pairs_;
  const double rate_hz = static_cast<double>(pairs - pairs_shown_) / (seconds > 0 ? seconds : 1);
  rate_hz_ = rate_hz_ > 0 && on_terminal_ ? rate_hz_ + kNewShare * (rate_hz - rate_hz_) : rate_hz;
  pairs_shown_ = pairs;
  const auto& [left, right] = report.cameras;
  return fmt::format(
      "{:.1f} pairs/s  pairs {}  dropped {}  unpaired {}/{}  incomplete {}/{}  lost {}/{}",
      rate_hz_, report.pairs, report.dropped_pairs, left.unpaired, right.unpaired,
      left.counts.incomplete, right.counts.incomplete, left.counts.lost, right.counts.lost);
}

std::string LiveView::BodyLine(const Seen& seen) {
  const std::string start = fmt::format("{}: {}", seen.name, StatusWord(seen.status));
  if (!seen.pose) {
    return fmt::format("{}  blobs {}/{}", start, seen.detections_left, seen.detections_right);
  }
  return fmt::format("{}  balls {}/{}  {}", start, seen.pose->balls_left, seen.pose->balls_right,
                     PoseText(*seen.pose));
}

std::string LiveView::LatencyLine(const std::optional<RecorderCounts>& recorded) const {
  std::string line = bodies_.empty() ? "" : fmt::format("latency {:.1f} ms", latency_ms_);
  if (recorded) {
    line += fmt::format("{}recorded {} pairs, {:.2f} GB", line.empty() ? "" : "  ", recorded->pairs,
                        static_cast<double>(recorded->bytes) / kBytesPerGigabyte);
  }
  return line;
}

std::vector<std::string> LiveView::Alarms(const LiveReport& report,
                                          const std::optional<RecorderCounts>& recorded,
                                          Clock::time_point now) {
  std::vector<std::string> alarms;
  for (const Seen& seen : bodies_) {
    const double lost_s = std::chrono::duration<double>(now - seen.posed_at).count();
    if (lost_s < kLostAlarm_s) continue;
    alarms.push_back(fmt::format("! {}: no pose for {:.0f} s", seen.name, lost_s));
  }
  if (report.dropped_pairs > dropped_shown_) {
    alarms.emplace_back("! measuring is slower than the cameras: pairs are dropped");
  }
  dropped_shown_ = report.dropped_pairs;
  if (report.free_running) alarms.emplace_back("! the cameras do not take their images together");
  if (recorded && !recorded->problem.empty()) alarms.push_back("! " + recorded->problem);
  if (recorded && recorded->problem.empty() && recorded->dropped > 0) {
    alarms.push_back(fmt::format("! the disk is too slow: {} not recorded", recorded->dropped));
  }
  return alarms;
}

void LiveView::Show(const LiveReport& report, const std::optional<RecorderCounts>& recorded) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  std::vector<std::string> lines = {StreamLine(report, now)};
  for (const Seen& seen : bodies_) lines.push_back(BodyLine(seen));
  lines.push_back(LatencyLine(recorded));
  for (std::string& alarm : Alarms(report, recorded, now)) lines.push_back(std::move(alarm));
  shown_at_ = now;
  if (on_terminal_) Draw(lines);
  if (on_log_) spdlog::info("{}", fmt::join(lines, "; "));
}

void LiveView::Draw(const std::vector<std::string>& lines) {
  std::string text = lines_drawn_ > 0 ? fmt::format("\r\x1b[{}A\x1b[J", lines_drawn_) : "";
  // A line that the terminal would break in two would be drawn at the wrong height.
  for (const std::string& line : lines) text += "\x1b[?7l" + line + "\x1b[?7h\n";
  lines_drawn_ = lines.size();
  std::fputs(text.c_str(), stderr);
}

void LiveView::Clear() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (lines_drawn_ > 0) std::fputs(fmt::format("\r\x1b[{}A\x1b[J", lines_drawn_).c_str(), stderr);
  lines_drawn_ = 0;
}

}  // namespace stereomotion::app
