#pragma once

#include <Eigen/Core>
#include <vector>

#include "ball_model.h"
#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/core/sensor_noise.h"

namespace stereomotion {

/// Cuts the surroundings of a blob out of an image. Keeps its memory.
class BallWindow {
 public:
  /// Widths around the box of the blob at half height.
  struct Margins {
    double tail_px;  ///< where the ball's light still is: pixel by pixel
    double ring_px;  ///< beyond it: background, in sums
  };

  /// Fills `patch` with the pixels of an ellipse around the blob, those of other blobs left out.
  /// Where the ring holds a pixel that is only a bound (zero, saturated), it is cut pixel by pixel
  /// too.
  void Cut(const ImageView& image, const Segmenter& segments, const Blob& blob,
           const SensorNoise& noise, const Margins& margins, BallPatch& patch);

  /// Half the size of what was cut, margins apart: of the blob's box, of a longish blob more.
  [[nodiscard]] Eigen::Vector2d half_px() const { return half_px_; }

  /// The pixel that the patch's coordinates count from.
  [[nodiscard]] Eigen::Vector2d origin_px() const { return {origin_u_, origin_v_}; }

 private:
  void MaskBlobs(const Segmenter& segments, const Blob& blob);
  void MaskPixels(const ImageMask& mask);
  void StartMasking();
  template <class IsOwn>
  void MaskRuns(const RunList& list, int margin_px, const IsOwn& is_own);
  template <class T>
  bool CutRows(const ImageView& image, const Blob& blob, const SensorNoise& noise,
               const Margins& margins, BallPatch& patch);
  template <class T>
  void TakePixels(const T* pixels, int v, int u_begin, int u_end, BallPatch& patch) const;
  template <class T>
  bool TakeRing(const T* pixels, int v, int u_begin, int u_end, double saturation_dn,
                BackgroundSums& ring) const;
  [[nodiscard]] bool IsMasked(int u, int v) const {
    return any_masked_ &&
           masked_[static_cast<std::size_t>((v - v_min_) * (u_max_ - u_min_ + 1) + u - u_min_)] !=
               0;
  }

  int u_min_ = 0, u_max_ = 0, v_min_ = 0, v_max_ = 0;  ///< inclusive
  int origin_u_ = 0, origin_v_ = 0;
  Eigen::Vector2d half_px_ = Eigen::Vector2d::Zero();
  bool any_masked_ = false;
  std::vector<unsigned char> masked_;
};

}  // namespace stereomotion
