#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/camera/rig.h"
#include "stereomotion/core/body.h"
#include "stereomotion/core/pair_source.h"
#include "stereomotion/core/run_summary.h"

namespace stereomotion::app {

/// Tells how the frames of both cameras came (0 left, 1 right); of a recording or live.
struct StreamFacts {
  std::array<std::string, 2> names;
  bool live = false;
  bool timed = true;  ///< the frames have timestamps of their own
  std::array<std::int64_t, 2> frames{};
  std::array<std::int64_t, 2> unpaired{};
  std::array<std::int64_t, 2> incomplete{};  ///< images with bytes missing; live only
  std::array<std::int64_t, 2> lost{};        ///< never came; live only
  std::int64_t pairs = 0;
  double watched_s = 0;             ///< since the first image; live only; 0: not as long as asked
  std::array<double, 2> rate_hz{};  ///< of the images that came; live only; 0: too few
  std::array<double, 2> down_s{};   ///< without connection; live only
  double period_s = 0;              ///< 0: unknown
  double skew_ms = 0;               ///< median of right − left in the pairs
  double jitter_ms = 0;             ///< 1.4826 × median absolute deviation of it
  bool free_running = false;
  std::vector<std::string> warnings;
};

/// Holds pairs spread evenly over the time that was looked at.
struct Samples {
  std::vector<FramePair> pairs;
  StreamFacts stream;
};

/// Says what the images of one camera show.
struct CameraLook {
  std::string name;
  NoiseRecord noise;
  int width_px = 0, height_px = 0;
  std::int64_t images = 0;
  double brightest_share = 0;  ///< brightest pixel of all images, of saturation
  double balls = 0;            ///< whole ones an image, median
  double blobs = 0;            ///< whatever looks like a ball at all, an image, median
  double clipped = 0;          ///< blobs at the image border, mean an image
  // Medians over the whole balls of all images.
  double diameter_px = 0;
  double blur_px = 0;
  double smear_px = 0;
  double snr_db = 0;            ///< ball over background, against the background's noise
  double amplitude_dn = 0;      ///< ball over background
  double peak_share = 0;        ///< grey value of a ball's middle, of saturation
  double background_share = 0;  ///< grey value beside a ball, of saturation
  double saturated_share = 0;   ///< of a ball's pixels; where none is whole, of a blob's
  Eigen::AlignedBox2d seen_px;  ///< centres of all of them
  double area_share = 0;        ///< of the image's cells in which a ball was seen
};

/// Says what measuring with rig and body gave.
struct BodyLook {
  std::int64_t pairs = 0;
  std::int64_t poses = 0;  ///< pairs with a pose of every body
  std::map<std::string, std::int64_t> lost_by_reason;
  std::int64_t expected_balls = 0;     ///< of all bodies
  std::array<double, 2> used_balls{};  ///< mean in the pairs with a pose: left, right
  double false_blobs = 0;              ///< whole blobs that are no ball of a body, mean an image
  std::optional<double> median_chi2_dof;
  std::string swapped;     ///< what is said of exchanged cameras; empty: they are not
  std::string first_pose;  ///< where the first body is, for a person
};

/// What `check` judges. Of `body` and `rig` nothing is known without these files.
struct CheckFacts {
  StreamFacts stream;
  std::array<CameraLook, 2> cameras;
  std::optional<BodyLook> body;
};

}  // namespace stereomotion::app
