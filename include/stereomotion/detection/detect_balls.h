#pragma once

#include <memory>
#include <vector>

#include "stereomotion/core/image.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/core/sensor_noise.h"
#include "stereomotion/detection/ball_observation.h"

namespace stereomotion {

/// Names how a ball's centre is measured (docs/accuracy.md compares them).
enum class DetectorMethod {
  kMaximumLikelihood,  ///< fit of the ball's image under the sensor's noise: at the physical limit
  kWavelet,            ///< ellipse through subpixel edge points of the dyadic wavelet transform
  kCentroid            ///< intensity-weighted centroid: the fastest
};

/// Sets what the detector takes for a ball, and how it measures it.
struct DetectionOptions {
  DetectorMethod method = DetectorMethod::kMaximumLikelihood;
  double min_diameter_px = 3;   ///< smaller blobs are noise or glints
  double max_diameter_px = 64;  ///< larger blobs are lamps or walls
  /// A ball's pixels rise this far over the local background; or 5/6 of it, in the image smoothed
  /// by a box of 3×3 and in units of its noise, which finds balls of 6 px and more from 6 dB on.
  double threshold_sigma = 6;
  double min_axis_ratio = 0.6;  ///< of the fitted outline; beyond it is no ball seen by a camera
  double max_chi2_probability_exponent = 9;  ///< a fit worse than the 10^-x tail of χ² is flagged
  double min_signal_to_noise_db = 6;         ///< amplitude against background noise
  /// Blobs that are fitted, the clearest ones first: bounds the time that a frame of noise can
  /// take.
  int max_balls = 500;
};

/// Says where in an image a ball is looked for, all inclusive, and what it looked like before.
struct SearchWindow {
  int u_min = 0, u_max = 0, v_min = 0, v_max = 0;
  BallObservation expected;
};

/// Detects balls in images of one camera; keeps its work memory between images, so that nothing is
/// allocated once it is warm. One object a thread.
class BallDetector {
 public:
  /// Pixels of `mask` (static false reflections) are never taken for balls.
  explicit BallDetector(const SensorNoise& noise, const DetectionOptions& options = {},
                        ImageMask mask = {});
  ~BallDetector();
  BallDetector(BallDetector&&) noexcept;
  BallDetector& operator=(BallDetector&&) noexcept;

  /// Finds the balls of `image`, ordered by v, then u; `balls` is overwritten, its memory reused.
  ///
  /// One pass segments the image against a coarse map of local background and noise; then each blob
  /// is fitted by maximum likelihood with a Gaussian-blurred, shaded elliptical disc on a sloped
  /// background under `noise` (saturated and zero pixels are censored). The result depends on
  /// nothing but the image, the noise and the options. Throws std::invalid_argument where the mask
  /// has another size than the image.
  void Detect(const ImageView& image, std::vector<BallObservation>& balls);

  /// Finds balls in parts of the image only, against the background map of the last whole search;
  /// searches the whole image where there was none yet, or none of this size. Balls whose middles
  /// lie in a window are found as in a whole search, but for one that reaches more than 12 px out
  /// of all windows, and for what the image's other balls tell about a covered one (rods, usual
  /// size): balls outside the windows do not. One that lies in two windows is given once. Windows
  /// may reach out of the image. The expected balls start the fits.
  void Detect(const ImageView& image, const std::vector<SearchWindow>& windows,
              std::vector<BallObservation>& balls);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

/// Detects balls once, without keeping memory; for tests and single images.
std::vector<BallObservation> DetectBalls(const ImageView& image, const SensorNoise& noise,
                                         const DetectionOptions& options = {});

}  // namespace stereomotion
