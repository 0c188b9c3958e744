#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "disk_calls.h"
#include "segment_writer.h"

namespace stereomotion {

/// Makes the segments of a recording, each ahead of its need in a thread of its own: taking room on
/// the disk lasts longer than a frame.
class SegmentSupply {
 public:
  SegmentSupply(std::filesystem::path folder, const DiskCalls& disk);
  ~SegmentSupply();
  SegmentSupply(const SegmentSupply&) = delete;
  SegmentSupply& operator=(const SegmentSupply&) = delete;

  /// Starts making the next segment.
  void Prepare(const std::vector<SegmentCamera>& cameras);
  /// Hands out the segment that was prepared, waiting for it, or one made now where none was or
  /// where it lacks a camera. Throws `OutputError` of either.
  std::shared_ptr<SegmentWriter> Next(const std::vector<SegmentCamera>& cameras);
  /// Removes what was prepared and is not needed.
  void Discard();

 private:
  std::shared_ptr<SegmentWriter> Make(const std::vector<SegmentCamera>& cameras) const;
  void Work();

  const std::filesystem::path folder_;
  const DiskCalls& disk_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stop_ = false, wanted_ = false;
  int number_ = 0;  // of the segment that is made or ready
  std::vector<SegmentCamera> cameras_;
  std::shared_ptr<SegmentWriter> ready_;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace stereomotion
