#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "camera_timeline.h"
#include "clock_pair.h"
#include "frame_dating.h"
#include "pair_statistics.h"
#include "ring.h"
#include "stereomotion/capture/live_pairs.h"

namespace stereomotion {

struct MatcherOptions {
  std::optional<std::int64_t> tolerance_ns;  ///< nothing: a quarter of the period
  std::size_t most_held = 512;  ///< images of a camera that wait for the clocks to be known
};

/// Chooses them for cameras of that image size.
MatcherOptions MatcherOptionsOf(const LiveOptions& live, const DeviceInfo& info);

/// Tells how the images were put together so far.
struct MatcherSummary {
  std::int64_t pairs = 0;
  std::array<std::int64_t, 2> unpaired{};
  std::array<std::int64_t, 2> misdated{};    ///< dropped: not later than the image before
  std::array<std::int64_t, 2> clock_sets{};  ///< within a connection
  std::int64_t ambiguous = 0;                ///< images that had two partners equally near, so none
  std::int64_t given_up = 0;  ///< how often the clocks were learned anew for want of pairs
  std::int64_t tolerance_ns = 0;
  double skew_ns = 0;    ///< median of right − left
  double jitter_ns = 0;  ///< 1.4826 × median absolute deviation
  double phase_ns = 0;   ///< right − left of the nearest images, where they are no pairs
};

/// Puts together the images of two cameras as they come; a thread's worth of work without threads
/// or clocks of its own.
///
/// A pair is two images nearer than the tolerance on one time line, and nearest to each other by
/// far. An image whose partner has not come half a second after it is given away alone. While the
/// relation of the clocks is unknown, images wait, a second or two, then they are given away alone.
/// Left images are given away in their order, right ones in theirs.
class FrameMatcher {
 public:
  using Sink =
      std::function<void(const std::shared_ptr<Frame>& left, const std::shared_ptr<Frame>& right)>;

  FrameMatcher(const MatcherOptions& options, Sink sink);
  FrameMatcher(const FrameMatcher&) = delete;
  FrameMatcher& operator=(const FrameMatcher&) = delete;
  /// Says that the cameras have one clock; before the first image.
  void TakeOneClock() { clocks_ = ClockPair(true); }
  /// Takes an image that came from camera 0 (left) or 1 (right).
  void Take(int camera, LiveFrame frame);
  /// Notes that a camera is lost: nothing is waited for until an image comes again.
  void SetDown(int camera);
  /// Gives away what can be told by now (host time).
  void Advance(std::int64_t now_ns);
  /// Gives away all.
  void Finish();

  [[nodiscard]] MatcherSummary summary() const;
  [[nodiscard]] const ClockPair& clocks() const { return clocks_; }
  [[nodiscard]] const FrameDating& dating() const { return dating_; }

 private:
  static std::size_t Index(int camera) { return static_cast<std::size_t>(camera); }
  bool StepLocked(std::int64_t now_ns);
  bool StepLone(int camera, std::int64_t now_ns);
  bool StepHeads(std::int64_t now_ns);
  bool ReleaseHeld(std::int64_t now_ns);
  void TryLock(std::int64_t now_ns);
  void StartNewClock(int camera);
  [[nodiscard]] bool HasWaited(int camera, std::int64_t now_ns) const;
  [[nodiscard]] std::int64_t DifferenceNs(std::size_t left, std::size_t right) const;
  [[nodiscard]] std::optional<std::int64_t> RivalNs(int camera) const;
  [[nodiscard]] std::int64_t ToleranceNs() const;
  void GiveEarlier(std::int64_t difference_ns);
  void GiveIfNumbersAgree();
  void GivePair();
  void GiveAlone(int camera);
  void CheckStarving();

  MatcherOptions options_;
  Sink sink_;
  ClockPair clocks_;
  std::array<Ring<LiveFrame>, 2> waiting_;
  FrameDating dating_{clocks_};
  std::array<bool, 2> down_{};
  std::array<std::int64_t, 2> alone_in_a_row_{};
  NumberRule numbers_;
  bool try_lock_ = false;
  std::array<std::vector<std::int64_t>, 2> times_ns_;
  PairStatistics statistics_;
  MatcherSummary counts_;
};

}  // namespace stereomotion
