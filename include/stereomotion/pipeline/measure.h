#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/image_mask.h"
#include "stereomotion/core/pair_source.h"
#include "stereomotion/core/run_summary.h"
#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/pipeline/pose_tracker.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Says what is measured: which cameras of the rig see which bodies.
struct MeasureSetup {
  Rig rig;
  int left_camera = 0;  ///< index into `rig.cameras`
  int right_camera = 1;
  std::vector<Body> bodies;         ///< one or more, told apart by their rods
  ImageMask left_mask, right_mask;  ///< of the cameras' image sizes; empty: none
};

struct MeasureOptions {
  DetectionOptions detection;
  TrackerOptions tracker;
  int threads = 0;  ///< 0: as many as the machine has cores
  /// Pairs from which the noise is learned before the run; sought among the first `kPairsKept`.
  int noise_pairs = 8;
  /// Every how manyth image of a camera is searched whole; the others only where the balls seen
  /// before should be. A ball that comes into sight is then found up to `search_every` − 1 images
  /// late.
  int search_every = 1;
  double exposure_us = 0;   ///< of frames that do not tell theirs; 0: unknown
  std::int64_t first = 0;   ///< position of the first pair
  std::int64_t count = -1;  ///< −1: to the end
};

/// Takes each measurement in frame order, of a pair body by body in the order of
/// `MeasureSetup::bodies`; returns false to end the run (disk full).
using MeasurementSink = std::function<bool(const PairMeasurement&)>;

/// Holds what is known of one body's pose as soon as it was tracked: before its neighbours in time
/// moved it to mid-exposure and the rig's covariance was propagated. Both change it by no more than
/// poses of strongly smeared balls show.
struct PromptPose {
  int body = 0;  ///< index into `MeasureSetup::bodies`
  std::int64_t frame = -1;
  std::int64_t timestamp_ns = 0;
  double exposure_us = 0;  ///< of the left image; 0: unknown
  PoseStatus status = PoseStatus::kLost;
  const PoseEstimate* pose = nullptr;  ///< null without one; valid during the call
  int detections_left = 0, detections_right = 0;
};

/// Takes each pose at once, body by body in frame order, two pairs before `MeasurementSink` gets
/// it; from the same thread. What it does changes no result.
using PromptSink = std::function<void(const PromptPose&)>;

/// Measures a recording: learn the noise → per pair read, detect (in parallel), track every body's
/// pose, move it to mid-exposure, give every ball its 3D point, propagate the rig's covariance →
/// `sink`, in frame order, two pairs behind (a pose's motion is told by those around it).
///
/// Balls are detected once; a detection serves one body only (`BodyTrackers` in the sources says
/// which).
///
/// The measurements do not depend on `threads`, nor on whether the source is a recording or an
/// endless source that delivers the same pairs. `stop` (may be null) ends the run after the pairs
/// in hand; an endless source that is made to end (its `Read` is false) ends it after all pairs
/// that it still had. Memory does not grow with the number of pairs.
RunSummary MeasureRecording(const PairSource& source, const MeasureSetup& setup,
                            const MeasureOptions& options, const MeasurementSink& sink,
                            const std::atomic<bool>* stop = nullptr, const PromptSink& prompt = {});

}  // namespace stereomotion
