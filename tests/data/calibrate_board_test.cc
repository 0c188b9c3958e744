// A chessboard in real image pairs, beside OpenCV's stereoCalibrate on the same corners and views.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <opencv2/calib3d.hpp>
#include <string>
#include <vector>

#include "stereomotion/calibration/calibrate.h"
#include "stereomotion/calibration/observe_target.h"
#include "tests/support/board_score.h"
#include "tests/support/number_table.h"
#include "tests/support/opencv_stereo.h"
#include "tests/support/recording_run.h"

namespace stereomotion::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kWidthPx = 640;
constexpr int kHeightPx = 480;
constexpr std::size_t kCorners = 54;

fs::path Folder() { return SharedData() / "real/board_opencv"; }

Target MakeTarget() {
  Target target;
  target.type = TargetType::kChessboard;
  target.rows = 6;
  target.cols = 9;
  target.spacing_mm = 25;  // nothing states it; neither error depends on it
  target.points = MakeBoardPoints(target);
  return target;
}

using Corners = std::array<std::vector<cv::Point2f>, 2>;

/// The corners of all pairs; `whole`: pairs in which both images show all of them.
struct Pairs {
  Target target = MakeTarget();
  std::vector<TargetObservation> observations;
  std::vector<Corners> corners;  // by view
  std::vector<int> whole;
};

Pairs ObservePairs() {
  Pairs pairs;
  for (const int number : {1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14}) {
    const int view = static_cast<int>(pairs.corners.size());
    Corners& corners = pairs.corners.emplace_back();
    for (const int camera : {0, 1}) {
      const std::string name = fmt::format("{}{:02}.jpg", camera == 0 ? "left" : "right", number);
      const Image image = ReadGrey(Folder() / name);
      const TargetSight sight = ObserveTarget(image.View(), pairs.target, {camera, view, {}, {}});
      for (const TargetObservation& o : sight.observations) {
        pairs.observations.push_back(o);
        corners[static_cast<std::size_t>(camera)].emplace_back(static_cast<float>(o.pixel_px.x()),
                                                               static_cast<float>(o.pixel_px.y()));
      }
    }
    const bool whole = corners[0].size() == kCorners && corners[1].size() == kCorners;
    if (whole) pairs.whole.push_back(view);
  }
  return pairs;
}

std::vector<TargetObservation> OfViews(const Pairs& pairs, const std::vector<int>& views) {
  std::vector<TargetObservation> observations;
  for (const TargetObservation& o : pairs.observations) {
    if (std::count(views.begin(), views.end(), o.view) > 0) observations.push_back(o);
  }
  return observations;
}

Calibration CalibrateOurs(const Pairs& pairs, const std::vector<int>& views) {
  CalibrationSetup setup;
  setup.target = pairs.target;
  for (const char* name : {"left", "right"}) {
    CalibrationCamera& camera = setup.cameras.emplace_back();
    camera.name = name;
    camera.width_px = kWidthPx;
    camera.height_px = kHeightPx;
  }
  CalibrateOptions options;
  options.image_sigma_known = false;  // as `calibrate` does for boards
  auto calibration = Calibrate(setup, OfViews(pairs, views), options);
  if (!calibration) throw std::runtime_error(calibration.error().text);
  return *calibration;
}

/// Board and corners of some views as OpenCV takes them.
StereoViews ViewsForOpenCv(const Pairs& pairs, const std::vector<int>& views) {
  std::vector<cv::Point3f> board;
  for (const TargetPoint& point : pairs.target.points) {
    board.emplace_back(static_cast<float>(point.xyz_mm.x()), static_cast<float>(point.xyz_mm.y()),
                       0.0F);
  }
  StereoViews stereo{{kWidthPx, kHeightPx}, {}, {}, {}};
  for (const int view : views) {
    const Corners& corners = pairs.corners[static_cast<std::size_t>(view)];
    stereo.boards.push_back(board);
    stereo.left.push_back(corners[0]);
    stereo.right.push_back(corners[1]);
  }
  return stereo;
}

std::vector<Eigen::Vector3d> NominalPoints(const Target& target) {
  std::vector<Eigen::Vector3d> points_mm;
  for (const TargetPoint& point : target.points) points_mm.push_back(point.xyz_mm);
  return points_mm;
}

std::string Row(const std::string& name, const BoardScore& score) {
  return fmt::format("{:34} {:8.4f} {:8.4f}\n", name, score.EpipolarPx(), score.StereoPx());
}

class CalibrateRealBoard : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(Folder())) GTEST_SKIP() << Folder().string() << " is not here";
  }
};

TEST_F(CalibrateRealBoard, PairsAndCornersAreKept) {
  const Pairs pairs = ObservePairs();
  const Calibration calibration = CalibrateOurs(pairs, pairs.whole);
  const auto used = std::count_if(calibration.residuals.begin(), calibration.residuals.end(),
                                  [](const CalibrationResidual& r) { return r.used; });
  const auto views = std::count(calibration.view_used.begin(), calibration.view_used.end(), true);
  const double share =
      static_cast<double>(used) / static_cast<double>(2 * kCorners * pairs.corners.size());
  EXPECT_GE(views, 11);
  EXPECT_GE(share, 0.97);
  RecordProperty("corners_kept", std::to_string(share));
  fmt::print(
      "{} of {} pairs found whole, {} used, {} corners found, {} used ({:.1f} %), RMS {:.4f} "
      "px\n",
      pairs.whole.size(), pairs.corners.size(), views, pairs.observations.size(), used, 100 * share,
      calibration.rms_px);
  for (const auto& note : calibration.warnings) fmt::print("  {}: {:.160}\n", note.name, note.text);
}

/// Each pair is judged by calibrations from all others.
TEST_F(CalibrateRealBoard, LeftOutPairsFitBetterThanOpenCvs) {
  const Pairs pairs = ObservePairs();
  const std::vector<Eigen::Vector3d> nominal_mm = NominalPoints(pairs.target);
  BoardScore ours, ours_flat, fixed, joint;
  for (const int left_out : pairs.whole) {
    std::vector<int> others = pairs.whole;
    others.erase(std::find(others.begin(), others.end(), left_out));
    const auto add = [&](const Rig& rig, const auto& points_mm, BoardScore& score) {
      AddPair(rig, points_mm, pairs.observations, left_out, score);
    };
    const StereoViews stereo = ViewsForOpenCv(pairs, others);
    const Calibration calibration = CalibrateOurs(pairs, others);
    add(calibration.rig, calibration.points_mm, ours);  // the board's shape is part of the result
    add(calibration.rig, nominal_mm, ours_flat);
    add(CalibrateWithOpenCv(stereo, cv::CALIB_FIX_INTRINSIC), nominal_mm, fixed);
    add(CalibrateWithOpenCv(stereo, cv::CALIB_USE_INTRINSIC_GUESS), nominal_mm, joint);
  }
  EXPECT_LT(ours.EpipolarPx(), std::min(fixed.EpipolarPx(), joint.EpipolarPx()));
  EXPECT_LT(ours.StereoPx(), std::min(fixed.StereoPx(), joint.StereoPx()));
  RecordProperty("epipolar_px", std::to_string(ours.EpipolarPx()));
  RecordProperty("stereo_px", std::to_string(ours.StereoPx()));
  fmt::print("{} pairs, each left out once; RMS px: {:>13} {:>8}\n{}{}{}{}", pairs.whole.size(),
             "epipolar", "stereo", Row("ours", ours), Row("ours, board taken as flat", ours_flat),
             Row("OpenCV, intrinsics first, then fixed", fixed), Row("OpenCV, all jointly", joint));
}

}  // namespace
}  // namespace stereomotion::testing
