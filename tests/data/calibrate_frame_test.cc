// The classic control frame in real images, detection included: `real/control_frame_myptv`.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "stereomotion/calibration/calibrate.h"
#include "stereomotion/calibration/dlt.h"
#include "tests/support/real_control_frame.h"

namespace stereomotion::testing {
namespace {

const RealControlFrame& Frame() {
  static const RealControlFrame frame = ObserveRealControlFrame();
  return frame;
}

class CalibrateRealFrame : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasRealControlFrame()) GTEST_SKIP() << "real/control_frame_myptv is not here";
  }
};

/// The dots stand 30 to 40 px apart.
constexpr double kSamePlacePx = 2;

/// Where all of the peer's points together put a point: the peer's single centroids are drawn away
/// by glints, one of them by 2.4 px from its own 410 neighbours. Distortion is 0.5 px here (RMS).
class PeerPlaces {
 public:
  PeerPlaces(const Target& target, const RealFrameCamera& camera) : target_(target) {
    std::vector<Eigen::Vector3d> points_mm;
    std::vector<Eigen::Vector2d> pixels_px;
    for (const auto& [point, pixel_px] : camera.peer_px) {
      points_mm.push_back(target.points[static_cast<std::size_t>(point)].xyz_mm);
      pixels_px.push_back(pixel_px);
    }
    dlt_ = FitDlt(points_mm, pixels_px).value();
  }
  [[nodiscard]] Eigen::Vector2d At(int point) const {
    const auto& p_mm = target_.points[static_cast<std::size_t>(point)].xyz_mm;
    return (dlt_ * p_mm.homogeneous()).hnormalized();
  }

 private:
  const Target& target_;
  Eigen::Matrix<double, 3, 4> dlt_;
};

struct Findings {
  int found = 0, wrong = 0, glints = 0;  // glints: only the peer's own single centroid is away
  double worst_px = 0;                   // from the peer's centroid
};

Findings CompareWithPeer(const Target& target, const RealFrameCamera& camera) {
  const PeerPlaces places(target, camera);
  Findings findings;
  for (const TargetObservation& o : camera.sight.observations) {
    const auto peer = camera.peer_px.find(o.point);
    if (peer == camera.peer_px.end()) continue;
    const double apart_px = (o.pixel_px - peer->second).norm();
    const bool at_peer = apart_px < kSamePlacePx;
    const bool at_place = (o.pixel_px - places.At(o.point)).norm() < kSamePlacePx;
    ++(at_peer || at_place ? findings.found : findings.wrong);
    findings.glints += at_place && !at_peer ? 1 : 0;
    findings.worst_px = std::max(findings.worst_px, apart_px);
  }
  return findings;
}

TEST_F(CalibrateRealFrame, DotsAreFoundFromSixSeeds) {
  for (const RealFrameCamera& camera : Frame().cameras) {
    SCOPED_TRACE(camera.name);
    EXPECT_EQ(camera.num_seeds, 6);
    EXPECT_FALSE(camera.sight.problem);
    const Findings findings = CompareWithPeer(Frame().target, camera);
    const auto listed = static_cast<double>(camera.peer_px.size());
    const double share = findings.found / listed;
    EXPECT_GE(share, 0.98);
    EXPECT_EQ(findings.wrong, 0) << "farthest from the peer's place: " << findings.worst_px;
    RecordProperty(camera.name + "_found", std::to_string(share));
    fmt::print(
        "{}: {} dots labelled; of the peer's {} {} ({:.1f} %) found, {} wrong, at most "
        "{:.2f} px from the peer's centroid, {} of the peer's off its own fit\n",
        camera.name, camera.sight.observations.size(), listed, findings.found, 100 * share,
        findings.wrong, findings.worst_px, findings.glints);
  }
}

TEST_F(CalibrateRealFrame, HeldOutDotsAreNearTheirSurvey) {
  const double bars_mm[] = {0.085, 0.14, 0.070};  // issue 3
  const std::vector<RealPair> pairs = MakeRealPairs(Frame());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const RealPair& pair = pairs[i];
    SCOPED_TRACE(pair.name);
    const auto calibration = Calibrate(pair.setup, pair.observations);
    ASSERT_TRUE(calibration) << calibration.error().text;
    ASSERT_TRUE(calibration->cross_validation);
    const CrossValidation& held_out = *calibration->cross_validation;
    EXPECT_LE(held_out.rms_mm, bars_mm[i]);
    EXPECT_EQ(held_out.folds, 5);
    EXPECT_EQ(held_out.num_points, static_cast<int>(pair.seen_by_both.size()));
    const auto outliers =
        std::count_if(calibration->residuals.begin(), calibration->residuals.end(),
                      [](const CalibrationResidual& r) { return !r.used; });
    RecordProperty("held_out_mm_" + pair.name, std::to_string(held_out.rms_mm));
    fmt::print(
        "cameras {}: {} dots seen by both, held-out 3D RMS {:.4f} mm (bar {}, predicted "
        "{:.4f}), residual RMS {:.3f} px, {} of {} image points left out of the fit\n",
        pair.name, held_out.num_points, held_out.rms_mm, bars_mm[i], held_out.predicted_rms_mm,
        calibration->rms_px, outliers, calibration->residuals.size());
    for (const auto& note : calibration->warnings) fmt::print("  {}: {}\n", note.name, note.text);
  }
}

}  // namespace
}  // namespace stereomotion::testing
