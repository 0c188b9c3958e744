#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stereomotion {

/// Names the storage of one grey pixel.
enum class PixelType { kGray8, kGray16 };

/// Views a grey image that somebody else owns. Row v, column u; pixel (0, 0) is the top-left one.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride_bytes = 0;
  PixelType type = PixelType::kGray8;
  int grey_bits = 0;  ///< 16-bit storage: the highest grey value is 2^grey_bits − 1; 0: not known

  /// Points at the first pixel of row `v`; `T` must fit `type`.
  template <class T>
  const T* Row(int v) const {
    return reinterpret_cast<const T*>(data + v * stride_bytes);
  }
  /// Reads one pixel [DN], whatever the storage.
  [[nodiscard]] double At(int u, int v) const {
    return type == PixelType::kGray8 ? Row<std::uint8_t>(v)[u] : Row<std::uint16_t>(v)[u];
  }
  [[nodiscard]] bool empty() const { return width_px <= 0 || height_px <= 0; }
};

/// Owns a grey image; keeps its memory when it is resized to the same size or smaller.
class Image {
 public:
  /// Forgets the grey bits, too.
  void Resize(int width_px, int height_px, PixelType type);
  /// Says how many bits a grey value has (`ImageView::grey_bits`).
  void SetGreyBits(int bits) { grey_bits_ = bits; }
  [[nodiscard]] ImageView View() const;
  template <class T>
  T* Row(int v) {
    return reinterpret_cast<T*>(bytes_.data() + v * stride_bytes_);
  }
  [[nodiscard]] bool empty() const { return width_px_ == 0; }

 private:
  std::vector<std::uint8_t> bytes_;
  int width_px_ = 0;
  int height_px_ = 0;
  std::ptrdiff_t stride_bytes_ = 0;
  PixelType type_ = PixelType::kGray8;
  int grey_bits_ = 0;
};

}  // namespace stereomotion
