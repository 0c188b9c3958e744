#include "record_progress.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>

namespace stereomotion::app {
namespace {

constexpr double kBytesPerMb = 1e6;
constexpr std::chrono::milliseconds kRedrawEvery{250};
// So long the rate is watched before anything is said of the disk.
constexpr double kRateKnown_s = 1;
// The disk is measured for a moment only, and other programs use it, too.
constexpr double kFastEnough = 1.25;

double Seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

RecordProgress::RecordProgress(std::filesystem::path output, DiskState disk, bool quiet)
    : output_(std::move(output)), disk_(disk), on_terminal_(!quiet && isatty(STDERR_FILENO) == 1) {}

void RecordProgress::Clear() const {
  if (on_terminal_) std::fputs("\r\x1b[K", stderr);
}

void RecordProgress::TellOfDisk(double bytes_s) {
  disk_told_ = true;
  Clear();
  spdlog::info("recording {:.1f} MB/s; the disk has {}", bytes_s / kBytesPerMb,
               RoomInWords(disk_.free_bytes, bytes_s));
  if (disk_.write_bytes_s <= 0 || disk_.write_bytes_s > kFastEnough * bytes_s) return;
  spdlog::warn(
      "{}: the disk wrote {:.0f} MB/s when it was tried, the cameras deliver {:.0f} MB/s: pairs "
      "will be dropped once the memory for waiting ones is full; take a faster disk, a smaller "
      "--region, a lower --frame-rate or an 8-bit --pixel-format",
      output_.string(), disk_.write_bytes_s / kBytesPerMb, bytes_s / kBytesPerMb);
}

void RecordProgress::TellWarnings(const LiveReport& report, const RecorderCounts& counts) {
  for (const std::string& warning : told_.New(report)) {
    Clear();
    spdlog::warn(warning);
  }
  if (dropped_told_ || counts.dropped == 0 || !counts.problem.empty()) return;
  Clear();
  spdlog::warn("{}: the disk is too slow: pairs are dropped (and counted)", output_.string());
  dropped_told_ = true;
}

void RecordProgress::Show(const LiveReport& report, const RecorderCounts& counts) {
  const Clock::time_point now = Clock::now();
  TellWarnings(report, counts);
  if (bytes_at_first_ == 0 && counts.bytes > 0) {
    first_bytes_ = now;
    bytes_at_first_ = counts.bytes;
  }
  const double watched_s = bytes_at_first_ > 0 ? Seconds(now - first_bytes_) : 0;
  const double bytes_s =
      watched_s > 0 ? static_cast<double>(counts.bytes - bytes_at_first_) / watched_s : 0;
  if (!disk_told_ && watched_s >= kRateKnown_s && bytes_s > 0) TellOfDisk(bytes_s);
  if (on_terminal_ && now - drawn_ >= kRedrawEvery) {
    drawn_ = now;
    Draw(report, counts, bytes_s);
  }
}

void RecordProgress::Draw(const LiveReport& report, const RecorderCounts& counts, double bytes_s) {
  const double rate_hz = report.period_s > 0 ? 1 / report.period_s : 0;
  disk_.free_bytes = FreeBytes(output_);
  const std::string line =
      fmt::format("\r{:.0f} s  {} pairs  {:.1f}/s  {} dropped  {:.0f} MB/s  disk: {}\x1b[K",
                  Seconds(Clock::now() - start_), counts.pairs, rate_hz, counts.dropped,
                  bytes_s / kBytesPerMb, RoomInWords(disk_.free_bytes, bytes_s));
  std::fputs(line.c_str(), stderr);
}

}  // namespace stereomotion::app
