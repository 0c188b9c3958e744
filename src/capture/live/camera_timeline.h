#pragma once

#include <cstdint>
#include <memory>

#include "clock_fit.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

/// Holds an image as it came from a camera, before its place is known.
struct LiveFrame {
  std::shared_ptr<Frame> frame;
  std::int64_t frame_id = 0;
  std::int64_t device_ns = 0;
  std::int64_t host_ns = 0;
  int epoch = 0;
};

/// Says how an image's number and time follow the ones before.
enum class Succession {
  kNext,
  kNewClock,  ///< the camera was opened anew, or its clock was set
  kMisdated,  ///< not later than the image before: it has no usable time
};

/// Keeps the numbers and times of one camera going on, whatever its own counters do.
class CameraTimeline {
 public:
  /// Takes notice of an image that came.
  Succession Admit(const LiveFrame& frame);
  /// Numbers and dates an image; images come in order. `timestamp_ns` gives way where it does not
  /// rise.
  void Stamp(const LiveFrame& frame, std::int64_t timestamp_ns, std::int64_t period_ns);

  [[nodiscard]] std::int64_t last_step_ns() const { return step_ns_; }
  [[nodiscard]] std::int64_t last_step_frames() const { return step_frames_; }
  /// Whether the last `kNewClock` came without a new connection.
  [[nodiscard]] bool was_set_within_connection() const { return set_within_; }
  [[nodiscard]] bool has_step() const { return step_frames_ > 0; }

 private:
  bool has_frame_ = false;
  LiveFrame last_;  ///< without the image
  std::int64_t step_ns_ = 0, step_frames_ = 0;
  bool set_within_ = false;

  bool numbered_ = false;  ///< the present epoch has its first number
  int stamped_epoch_ = 0;
  std::int64_t index_minus_id_ = 0;
  std::int64_t last_index_ = -1;
  std::int64_t last_timestamp_ns_ = 0;
};

/// Carries the left camera's first clock on over the epochs of its clock.
class LeftTime {
 public:
  /// The clock is going to be set anew; `line` is the last that was known of it.
  void EndEpoch(const ClockLine& line);
  /// What is added to device times of this epoch. `line` relates the new clock to the host.
  [[nodiscard]] std::int64_t ShiftBy(const ClockLine& line, std::int64_t period_ns) const;
  /// Keeps the shift for the rest of the epoch.
  void Fix(std::int64_t shift_ns);

 private:
  bool fixed_ = true;  ///< the first epoch's shift is zero
  std::int64_t shift_ns_ = 0;
  ClockLine before_;
};

}  // namespace stereomotion
