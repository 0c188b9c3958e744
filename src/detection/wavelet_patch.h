#pragma once

#include <Eigen/Core>

#include "segment_blobs.h"
#include "stereomotion/core/image.h"
#include "stereomotion/core/sensor_noise.h"
#include "wavelet_plane.h"

namespace stereomotion {

/// Holds the surroundings of one blob, other blobs painted over with the background.
struct WaveletPatch {
  /// Cuts `margin_px` more than the blob's half-height box out of the image; beyond the image's
  /// border its last row or column is repeated. Other blobs of the image are painted over: their
  /// light would reach the coarse scale. Pixels under paint and censored ones count as free of
  /// noise, for no noise of theirs reaches the result.
  void Cut(const ImageView& image, const Segmenter& segments, const Blob& blob,
           const SensorNoise& noise, int margin_px);

  Eigen::Vector2d origin_px = Eigen::Vector2d::Zero();  ///< image place of the patch's pixel (0, 0)
  WaveletPlane grey_dn;
  WaveletPlane variance_dn2;
  double saturated_share = 0;  ///< of the blob's pixels

 private:
  void PaintOver(const RunList& list, int own_label, int margin_px, float level_dn);
};

}  // namespace stereomotion
