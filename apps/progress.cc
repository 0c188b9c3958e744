#include "progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace stereomotion::app {
namespace {

constexpr std::chrono::milliseconds kRedrawEvery{100};
constexpr std::int64_t kWidth = 30;

}  // namespace

Progress::Progress(std::int64_t total, bool quiet, const char* unit)
    : total_(total), shown_(!quiet && total > 0 && isatty(STDERR_FILENO) == 1), unit_(unit) {}

Progress::~Progress() { Clear(); }

void Progress::Clear() const {
  if (shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::Step() {
  ++done_;
  const Clock::time_point now = Clock::now();
  if (!shown_ || (now - drawn_ < kRedrawEvery && done_ < total_)) return;
  drawn_ = now;
  Draw(std::chrono::duration<double>(now - start_).count());
}

void Progress::Draw(double elapsed_s) const {
  const auto filled = static_cast<std::size_t>(kWidth * done_ / total_);
  const std::string bar = std::string(filled, '#') + std::string(kWidth - filled, '.');
  const double rate = static_cast<double>(done_) / (elapsed_s > 0 ? elapsed_s : 1);
  const double left_s = static_cast<double>(total_ - done_) / (rate > 0 ? rate : 1);
  const std::string line = fmt::format("\r[{}] {}/{}  {:.1f} {}/s  {:.0f} s left\x1b[K", bar, done_,
                                       total_, rate, unit_, left_s);
  std::fputs(line.c_str(), stderr);
}

}  // namespace stereomotion::app
