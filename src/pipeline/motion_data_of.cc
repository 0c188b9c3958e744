#include "stereomotion/pipeline/motion_data_of.h"

#include <stdexcept>

namespace stereomotion {
namespace {

PoseSample SampleOf(const PairMeasurement& measurement) {
  PoseSample sample;
  sample.frame = measurement.frame;
  sample.timestamp_ns = measurement.timestamp_ns;
  if (!measurement.pose) return sample;
  sample.measured = true;
  sample.world_from_body = measurement.pose->world_from_body;
  sample.covariance = measurement.pose->covariance;
  sample.calibration_u = measurement.pose->calibration_u;
  sample.free_axis_in_world = measurement.pose->free_axis_in_world;
  return sample;
}

MotionFrame FrameOf(const PairMeasurement& measurement) {
  MotionFrame frame;
  frame.pose = SampleOf(measurement);
  if (!measurement.pose) return frame;
  // `measurement.balls` lists every ball of the body, rod by rod: its index is the ball's.
  for (std::size_t i = 0; i < measurement.balls.size(); ++i) {
    const BallMeasurement& ball = measurement.balls[i];
    for (const int camera : {0, 1}) {
      const auto& center = camera == 0 ? ball.left : ball.right;
      if (!center) continue;
      frame.image_points.push_back(
          {camera, static_cast<int>(i), center->center_px, center->covariance_px2});
    }
  }
  return frame;
}

/// Lets all coordinates count from the first ball; its uncertainty then is the others'.
void CountFromFirstBall(MotionData& data) {
  const Eigen::Vector3d first_mm = data.balls_in_body_mm.front();
  for (Eigen::Vector3d& p_mm : data.balls_in_body_mm) p_mm -= first_mm;
  Eigen::MatrixXd& covariance_mm2 = data.structure_covariance_mm2;
  Eigen::MatrixXd shift = Eigen::MatrixXd::Identity(covariance_mm2.rows(), covariance_mm2.cols());
  for (Eigen::Index i = 0; i < shift.rows(); i += 3) {
    shift.block<3, 3>(i, 0) -= Eigen::Matrix3d::Identity();
  }
  covariance_mm2 = (shift * covariance_mm2 * shift.transpose()).eval();
}

void PutStructure(const Body& body, bool single_rod, MotionData& data) {
  for (const Rod& rod : body.rods) {
    for (const Eigen::Vector3d& p_mm : rod.balls_in_body_mm) data.balls_in_body_mm.push_back(p_mm);
  }
  const Eigen::MatrixXd covariance_mm2 = CovarianceOfBalls(body);
  if (!covariance_mm2.isZero(0)) data.structure_covariance_mm2 = covariance_mm2;
  if (single_rod) CountFromFirstBall(data);
}

}  // namespace

MotionData MotionDataOf(const MeasureSetup& setup, const std::vector<PairMeasurement>& measurements,
                        int body) {
  if (body < 0 || body >= static_cast<int>(setup.bodies.size())) {
    throw std::invalid_argument("MotionDataOf: no such body");
  }
  MotionData data;
  data.rig = setup.rig;
  data.left_camera = setup.left_camera;
  data.right_camera = setup.right_camera;
  bool single_rod = false;
  for (const PairMeasurement& measurement : measurements) {
    if (measurement.body != body) continue;
    data.frames.push_back(FrameOf(measurement));
    single_rod = single_rod || (measurement.pose && measurement.pose->free_axis_in_world);
  }
  PutStructure(setup.bodies[static_cast<std::size_t>(body)], single_rod, data);
  return data;
}

}  // namespace stereomotion
