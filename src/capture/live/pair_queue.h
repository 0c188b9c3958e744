#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "ring.h"
#include "stereomotion/core/pair_source.h"

namespace stereomotion {

struct PairQueueLimits {
  double seconds = 1;
  std::int64_t bytes = 1 << 29;
};

/// Holds pairs that wait for being measured, by their place in the stream. What is too much loses
/// its images, the oldest first, and is delivered as `Frame::dropped`. The first `kPairsKept` pairs
/// are never dropped.
class PairQueue {
 public:
  explicit PairQueue(const PairQueueLimits& limits) : limits_(limits) {}

  /// Adds a pair at a host time; `right` may be null. Frames do not change any more.
  void Add(const std::shared_ptr<const Frame>& left, const std::shared_ptr<const Frame>& right,
           std::int64_t now_ns);
  /// No pair will come any more.
  void End();
  /// Waits for a pair and copies it; false: the stream ended before it.
  bool Read(std::int64_t position, FramePair& pair);

  /// Pairs of two images that were dropped.
  [[nodiscard]] std::int64_t dropped() const;
  /// Pairs that waited at once.
  [[nodiscard]] std::int64_t most_queued() const;

 private:
  /// What is left of a frame without its image.
  struct Header {
    std::int64_t index = -1, timestamp_ns = 0, device_ns = 0;
    double exposure_us = 0;
  };
  struct Row {
    std::shared_ptr<const Frame> left, right;  ///< null: dropped or taken; right: or no partner
    Header left_header, right_header;
    bool has_right = false;
    std::int64_t added_ns = 0;
  };
  static Header HeaderOf(const Frame& frame);
  static void Fill(const std::shared_ptr<const Frame>& image, const Header& header, Frame& frame);
  static std::int64_t Bytes(const Row& row);
  void DropOldest();
  void Release(Row& row);
  Row TakeRow(std::int64_t position);

  PairQueueLimits limits_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Row, kPairsKept> kept_;
  Ring<Row> rows_;                       ///< from place `first_` on
  std::int64_t first_ = kPairsKept;      ///< place of the ring's first row
  std::int64_t size_ = 0;                ///< rows ever added
  std::int64_t next_drop_ = kPairsKept;  ///< no row before it has images
  std::int64_t bytes_ = 0, queued_ = 0, dropped_ = 0, most_queued_ = 0;
  bool has_kept_ = true;
  bool ended_ = false;
};

}  // namespace stereomotion
