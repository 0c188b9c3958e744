#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "stereomotion/core/pair_source.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"
#include "stereomotion/detection/detect_balls.h"

namespace stereomotion {

/// Holds one frame pair on its way through reading and detection.
struct DetectedPair {
  FramePair frames;
  std::vector<BallObservation> left;
  std::vector<BallObservation> right;
  double read_ms = 0;
  double detect_ms = 0;
};

/// Reads pairs and detects their balls ahead on several threads; hands them out in order.
///
/// A pair's result depends on that pair alone, so the number of threads changes nothing but the
/// time. Holds a fixed number of pairs, whose memory is reused.
class OrderedPairs {
 public:
  struct Settings {
    std::int64_t first = 0;
    std::int64_t end = 0;  ///< one past the last position
    int threads = 1;
    SensorNoise noise_left, noise_right;
    DetectionOptions detection;
  };
  OrderedPairs(const PairSource& source, const Settings& settings);
  ~OrderedPairs();
  OrderedPairs(const OrderedPairs&) = delete;
  OrderedPairs& operator=(const OrderedPairs&) = delete;

  /// Waits for the next pair; null after the last. The pair stays valid until the next call. Throws
  /// what a worker threw.
  DetectedPair* Next();

 private:
  struct Slot {
    DetectedPair pair;
    bool ready = false;
  };
  void Work();
  void Stop();
  Slot& SlotOf(std::int64_t position) {
    return slots_[static_cast<std::size_t>(position) % slots_.size()];
  }

  const PairSource& source_;
  Settings settings_;
  std::vector<Slot> slots_;
  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::int64_t next_to_start_ = 0;
  std::int64_t next_to_hand_out_ = 0;  ///< all before it are free again
  bool handed_out_ = false;
  bool stop_ = false;
  std::exception_ptr error_;
};

}  // namespace stereomotion
