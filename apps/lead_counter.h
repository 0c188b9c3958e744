#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "stereomotion/capture/live_pairs.h"

namespace stereomotion::app {

/// Counts the images of one camera before the other one begins: they tell nothing of a take.
class LeadCounter : public FrameTap {
 public:
  void Take(const std::shared_ptr<const Frame>& left,
            const std::shared_ptr<const Frame>& right) override {
    if (left && right) has_pair_ = true;
    if (!has_pair_) ++alone_[left ? 0 : 1];
  }
  /// Those of a camera (0 left, 1 right); none where no pair ever came.
  [[nodiscard]] std::int64_t alone(std::size_t side) const {
    return has_pair_ ? alone_[side].load() : 0;
  }

 private:
  std::atomic<bool> has_pair_{false};
  std::array<std::atomic<std::int64_t>, 2> alone_{};
};

}  // namespace stereomotion::app
