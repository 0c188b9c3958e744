#pragma once

#include <cstdint>
#include <limits>

namespace stereomotion {

/// Bounds the work on one image, counted in pixels for which a model was evaluated: the same on
/// every machine, as a time would not be.
class WorkBudget {
 public:
  /// Begins an image.
  void Start(std::int64_t most_px) { left_px_ = most_px; }
  void Count(std::int64_t pixels) { left_px_ -= pixels; }
  [[nodiscard]] std::int64_t left_px() const { return left_px_; }
  [[nodiscard]] bool is_spent() const { return left_px_ <= 0; }

 private:
  std::int64_t left_px_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace stereomotion
