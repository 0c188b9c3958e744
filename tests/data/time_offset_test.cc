#include "stereomotion/motion/time_offset.h"

#include <gtest/gtest.h>

#include "tests/support/recording_run.h"
#include "tests/support/statistics.h"

namespace stereomotion::testing {
namespace {

/// Lays out what was measured of a recording as the input of the motion layer.
MotionData MotionDataOf(const RecordingRun& run) {
  MotionData data;
  data.rig = run.setup.rig;
  data.left_camera = run.setup.left_camera;
  data.right_camera = run.setup.right_camera;
  for (const Rod& rod : run.setup.bodies.front().rods) {
    data.balls_in_body_mm.insert(data.balls_in_body_mm.end(), rod.balls_in_body_mm.begin(),
                                 rod.balls_in_body_mm.end());
  }
  for (const PairMeasurement& pair : run.measurements) {
    MotionFrame frame;
    frame.pose.frame = pair.frame;
    frame.pose.timestamp_ns = pair.timestamp_ns;
    frame.pose.measured = pair.pose.has_value();
    if (pair.pose) {
      frame.pose.world_from_body = pair.pose->world_from_body;
      frame.pose.covariance = pair.pose->covariance;
    }
    for (std::size_t b = 0; b < pair.balls.size(); ++b) {
      const BallMeasurement& ball = pair.balls[b];
      for (const int camera : {0, 1}) {
        const auto& seen = camera == 0 ? ball.left : ball.right;
        if (!seen) continue;
        frame.image_points.push_back(
            {camera, static_cast<int>(b), seen->center_px, seen->covariance_px2});
      }
    }
    data.frames.push_back(frame);
  }
  return data;
}

constexpr int kTests = 3;  // consistency checks in this program

TEST(TimeOffsetRecordings, UnsyncIsFoundAndThePosesComeTrue) {
  const auto recording = SharedData() / "rendered" / "unsync";
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << recording << " is not here";
  const RecordingRun run = MeasureFolder(recording);
  const MotionData data = MotionDataOf(run);
  const auto found = EstimateTimeOffset(data);
  ASSERT_TRUE(found);
  RecordProperty("offset_ms", std::to_string(1e3 * found->offset_s));
  constexpr double kTrueOffsetS = 0.006;
  EXPECT_TRUE(found->significant);
  EXPECT_LT(std::abs(found->offset_s - kTrueOffsetS), FamilyZ(kTests) * found->u_s)
      << 1e3 * found->offset_s << " ± " << 1e3 * found->u_s << " ms, chi2/dof "
      << found->chi2_with / found->dof;
  EXPECT_GT(found->chi2_without, 10 * found->chi2_with);

  ErrorStatistics errors;
  for (const MotionFrame& frame : WithTimeOffset(data, found->offset_s, found->u_s).frames) {
    const Rigid3& truth = run.truth.at(frame.pose.frame).world_from_body;
    errors.Add(PerturbationBetween(truth, frame.pose.world_from_body), frame.pose.covariance);
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(kTests)));
}

TEST(TimeOffsetRecordings, SynchronousCamerasHaveNone) {
  const auto recording = SharedData() / "rendered" / "wide_precession";
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << recording << " is not here";
  const auto found = EstimateTimeOffset(MotionDataOf(MeasureFolder(recording)));
  ASSERT_TRUE(found);
  EXPECT_LT(std::abs(found->offset_s), FamilyZ(kTests) * found->u_s)
      << 1e3 * found->offset_s << " ± " << 1e3 * found->u_s << " ms";
}

}  // namespace
}  // namespace stereomotion::testing
