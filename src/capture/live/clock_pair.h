#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "clock_fit.h"
#include "frame_steps.h"
#include "image_phase.h"
#include "pair_statistics.h"
#include "stereomotion/capture/live_report.h"

namespace stereomotion {

/// Says whether pairs can be told at the moment, or why not.
enum class LockState {
  kLocked,
  kTooFewFrames,
  kAmbiguous,    ///< arrivals tell the offset of the clocks too roughly for this period
  kNotTogether,  ///< the images lie a quarter of a period or more apart: not triggered together
};

/// Relates the clocks of two cameras: left time = right time + `OffsetAt`. Cameras: 0 left, 1
/// right.
///
/// Cameras with one clock need no estimate: they say so, or their image times coincide to a
/// thousandth of a period, image by image, which clocks of their own do not by chance. Such times
/// are believed whatever arrivals say (a camera may send its images a period later than the other).
/// Else arrivals tell the offset (`ClockFit`) but for the
/// unknown difference of the two shortest delays. It must be known to an eighth of a period, and by
/// it the images must lie nearer to each other than a quarter: so a pair can be wrong by a whole
/// period only where the shortest delays differ by more than five eighths of one. Then the constant
/// part is the median of the pairs' own differences, exact to microseconds. From there on the
/// offset follows the pairs only within what arrivals allow: clocks that drift apart show it in
/// arrivals too; cameras that are not triggered together show it in their images only, and are not
/// followed but reported (`free_running`).
class ClockPair {
 public:
  /// `shared`: the cameras say that they have one clock.
  explicit ClockPair(bool shared) : shared_(shared) {}

  /// Adds an image's times; `host_ns` is its arrival less half the exposure. Whether it shows, by
  /// coming too early, that the relation was misjudged from the start.
  bool AddFrame(int camera, std::int64_t device_ns, std::int64_t host_ns);
  /// Adds the time from an image to the next one that came, `frames` numbers on.
  void AddStep(int camera, std::int64_t step_ns, std::int64_t frames);
  /// Forgets a camera's clock, which was set anew.
  void ResetClock(int camera);
  /// Gives up the relation and both clocks: something showed that they are not what was believed.
  void GiveUp();
  /// How often that happened.
  [[nodiscard]] std::int64_t given_up() const { return given_up_; }

  /// Tries to tell the relation from the device times of the images that wait. `patient`: the usual
  /// number of images was waited for long enough.
  void TryLock(const std::vector<std::int64_t>& left_ns, const std::vector<std::int64_t>& right_ns,
               bool patient);
  [[nodiscard]] bool locked() const { return state_ == LockState::kLocked; }
  [[nodiscard]] LockState state() const { return state_; }

  /// Left clock − right clock [ns] at a right device time; needs `locked`.
  [[nodiscard]] std::int64_t OffsetAt(std::int64_t right_ns) const;
  /// The best that can be said of it: where it is not locked, too rough for pairs.
  [[nodiscard]] std::optional<std::int64_t> BestOffsetAt(std::int64_t right_ns) const;
  /// The last that was said of it; 0 before.
  [[nodiscard]] std::int64_t last_offset_ns() const;
  /// The same from arrivals alone, now; nothing before both cameras have delivered.
  [[nodiscard]] std::optional<std::int64_t> OffsetByArrivals() const;
  /// Learns from a pair that was found.
  void TakePair(std::int64_t left_ns, std::int64_t right_ns);
  /// Notes that images of both cameras come and go without partners.
  void TakeNoPairs();

  /// The faster camera's; 0: not known yet.
  [[nodiscard]] std::int64_t period_ns() const;
  [[nodiscard]] const FrameSteps& steps(int camera) const { return steps_[Index(camera)]; }
  [[nodiscard]] const ClockLine& line(int camera) const { return fits_[Index(camera)].line(); }
  [[nodiscard]] ClockRelation relation() const { return relation_; }
  /// The right clock gains so much on the left one; nothing: not known to 20 ppm, or one clock.
  [[nodiscard]] std::optional<double> drift_ppm() const;
  [[nodiscard]] bool free_running() const { return free_running_; }
  /// The cameras said that they have one clock, but images arrive as if they had not.
  [[nodiscard]] bool distrusts_clocks() const { return distrusts_; }
  /// What the last `TryLock` found: images of the right camera lie so far behind the left's.
  [[nodiscard]] double phase_ns() const { return phase_ns_; }
  [[nodiscard]] double uncertainty_ns() const;

 private:
  static constexpr double kSteepestDrift = 500e-6;  ///< of two crystals, ns a ns

  static std::size_t Index(int camera) { return static_cast<std::size_t>(camera); }
  LockState Lock(const std::vector<std::int64_t>& left_ns,
                 const std::vector<std::int64_t>& right_ns, std::size_t wanted);
  LockState LockByCoincidence(const std::vector<std::int64_t>& left_ns,
                              const std::vector<std::int64_t>& right_ns, std::size_t wanted);
  LockState LockByArrivals(const std::vector<std::int64_t>& left_ns,
                           const std::vector<std::int64_t>& right_ns);
  void Settle(ClockRelation relation, std::int64_t offset_ns, double constant_ns);
  [[nodiscard]] bool IsEarly(int camera, std::int64_t device_ns, std::int64_t host_ns) const;
  void JudgeShared(double median_ns, double spread_ns);
  void JudgeCoincidence(double median_ns);
  void JudgeByArrivals(double median_ns, double spread_ns, std::int64_t right_ns);
  void JudgeWalk(double walk_ns, double limit_ns);
  void Follow(double target_ns, double spread_ns, std::int64_t right_ns);
  void CheckSharedClock();
  [[nodiscard]] double UsableSlope() const;

  bool shared_;
  bool distrusts_ = false;
  bool coincide_ = false;     ///< image times coincide: one clock, whoever says what
  bool may_coincide_ = true;  ///< until arrivals have told that the clocks are two
  double usual_apart_ns_ = std::numeric_limits<double>::infinity();  ///< of one clock, by arrivals
  std::array<ClockFit, 2> fits_;
  std::array<FrameSteps, 2> steps_;
  std::array<std::int64_t, 2> last_ns_{};
  LockState state_ = LockState::kTooFewFrames;
  ClockRelation relation_ = ClockRelation::kShared;
  bool free_running_ = false;
  std::int64_t given_up_ = 0;
  double phase_ns_ = 0;

  std::int64_t base_ns_ = 0;  ///< offset when locked; what follows is relative to it
  double offset_ns_ = 0;      ///< at `offset_at_ns_`
  std::int64_t offset_at_ns_ = 0;
  double constant_ns_ = 0;          ///< offset by pairs − offset by arrivals, of cameras in step
  double anchor_ns_ = 0;            ///< uncertainty with which `constant_ns_` was taken
  std::optional<double> first_ns_;  ///< median of the first block of pairs
  std::optional<int> suspect_;      ///< was locked until this camera's last image
  PairBlocks blocks_;
  ImagePhase phase_;
  int walks_ = 0;
  int apart_in_a_row_ = 0;
};

}  // namespace stereomotion
