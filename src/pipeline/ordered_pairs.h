#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "camera_search.h"
#include "stereomotion/core/pair_source.h"
#include "stereomotion/detection/ball_observation.h"

namespace stereomotion {

/// Holds one frame pair on its way through reading and detection.
struct DetectedPair {
  FramePair frames;
  std::vector<BallObservation> left;
  std::vector<BallObservation> right;
  double read_ms = 0;
  std::array<double, 2> detect_ms{};     ///< left, right
  std::array<bool, 2> searched_whole{};  ///< left, right
};

/// Reads pairs and detects their balls ahead on several threads; hands them out in order.
///
/// Where every image is searched whole, a pair's result depends on that pair alone, and a thread
/// does a pair. Else each camera's images are searched in their order, by whichever thread is free:
/// so too the number of threads changes nothing but the time. Holds a fixed number of pairs, whose
/// memory is reused.
class OrderedPairs {
 public:
  struct Settings {
    std::int64_t first = 0;
    std::int64_t end = 0;  ///< one past the last position; an endless source may end before it
    int threads = 1;
    SearchSettings left, right;  ///< equal `search_every`
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
    bool read = false;
    std::array<bool, 2> searched{};
    [[nodiscard]] bool ready() const { return read && searched[0] && searched[1]; }
  };
  /// One camera's searches, in order.
  struct Chain {
    CameraSearch search;
    std::int64_t next = 0;
    bool busy = false;
  };
  /// What a worker does next: reading a pair (`camera` −1), or searching one camera's image.
  struct Task {
    std::int64_t position = 0;
    int camera = -1;
  };
  void Work();
  void Stop();
  [[nodiscard]] bool IsAllStarted() const;
  std::optional<Task> NextTask();
  /// False: the source ended before this pair.
  bool Perform(const Task& task, std::vector<CameraSearch>& own);
  void Finish(const Task& task, bool is_there);
  Slot& SlotOf(std::int64_t position) {
    return slots_[static_cast<std::size_t>(position) % slots_.size()];
  }

  const PairSource& source_;
  Settings settings_;
  std::vector<Slot> slots_;
  std::vector<Chain> chains_;  ///< one a camera; empty where every image is searched whole
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
