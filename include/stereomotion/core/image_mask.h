#pragma once

#include <cstdint>
#include <vector>

namespace stereomotion {

/// Marks the pixels of one camera's images that hold no ball whatever they show: lamps, window
/// reflections. Empty: no pixel.
class ImageMask {
 public:
  ImageMask() = default;
  ImageMask(int width_px, int height_px);

  /// Marks the pixels [u_begin, u_end) of row v; all must lie inside.
  void Mark(int v, int u_begin, int u_end);

  [[nodiscard]] bool empty() const { return masked_.empty(); }
  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] bool IsMasked(int u, int v) const { return !empty() && Row(v)[u] != 0; }
  /// Points at a row's bytes, 1 where masked; only of a mask that is not empty.
  [[nodiscard]] const std::uint8_t* Row(int v) const {
    return masked_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px_);
  }
  [[nodiscard]] std::int64_t CountMasked() const;

 private:
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> masked_;
};

}  // namespace stereomotion
