#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace stereomotion {

/// Relates a camera's clock to the host's: host time − device time is a line in device time.
struct ClockLine {
  std::int64_t device_ns = 0;  ///< where the line is anchored
  double host_minus_device_ns = 0;
  std::int64_t base_ns = 0;  ///< added to it: the whole hours that a double need not carry
  double slope = 0;          ///< host ns gained a device ns

  /// Evaluates the line: host time − device time [ns].
  [[nodiscard]] std::int64_t HostMinusDevice(std::int64_t at_device_ns) const;
};

/// Learns the relation of a camera's clock to the host's from the arrivals of its images.
///
/// An image arrives late by a delay that is never negative and can be anything (a stalled network
/// hands over 100 ms of images at once); the least delayed ones tell the clock. So the line lies
/// under all points (device time, host − device time), as near to them as it can: the edge of their
/// lower convex hull above the mean time. It covers the last one to two minutes, so it follows a
/// clock that warms up. A lone point far below all others is left out: no delay is negative, but
/// the host's clock may have been set between taking an image over and dating it. A shortest delay
/// that rises for good (another way through the network) is seen and taken off from then on, so the
/// line goes on as if it had not.
class ClockFit {
 public:
  /// Adds an image; `device_ns` later than the one before.
  void Add(std::int64_t device_ns, std::int64_t host_ns);
  /// Forgets all: the clock was set anew.
  void Reset();

  /// Images since the start or the last `Reset`.
  [[nodiscard]] std::int64_t frames() const { return frames_; }
  /// The least delayed arrivals: later than the exposure by the shortest delay, which nothing here
  /// can tell.
  [[nodiscard]] const ClockLine& line() const { return line_; }
  /// Whether there ever was an image; the line outlives `Reset`.
  [[nodiscard]] bool has_line() const { return has_line_; }
  /// How far the line may lie from its place, besides the shortest delay: so far above it lie the
  /// few lowest points. A single early arrival (the last one of a burst) tells little, several
  /// alike tell much. Infinite below three images.
  [[nodiscard]] double uncertainty_ns() const { return uncertainty_ns_; }
  /// Of the slope; infinite below three images.
  [[nodiscard]] double slope_uncertainty() const;

 private:
  struct Point {
    double device_ns = 0;  // since base_device_ns_
    double delay_ns = 0;   // host − device − base_offset_ns_
  };
  bool HasFallen(std::int64_t device_ns, Point& point);
  bool LevelRise();
  [[nodiscard]] double LowestAbove(double from_ns, double to_ns) const;
  void Insert(const Point& point);
  void MergeNeighbours();
  void FitLine();
  std::optional<std::size_t> FindLone();
  [[nodiscard]] double SlopeOfLowerEdge(std::optional<std::size_t> lone);

  std::vector<Point> points_;  // the lowest of every bin, ascending in time
  std::vector<Point> hull_;
  std::vector<double> above_;
  std::int64_t base_device_ns_ = 0;
  std::int64_t base_offset_ns_ = 0;
  double risen_ns_ = 0;    ///< taken off all delays
  double falling_ns_ = 0;  ///< so much below the line lay the last image, while risen
  double bin_ns_ = 0;
  double bin_start_ns_ = 0;
  std::int64_t frames_ = 0;
  bool has_line_ = false;
  ClockLine line_;
  double uncertainty_ns_ = std::numeric_limits<double>::infinity();
};

}  // namespace stereomotion
