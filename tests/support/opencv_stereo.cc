#include "tests/support/opencv_stereo.h"

#include <opencv2/calib3d.hpp>

namespace stereomotion::testing {
namespace {

/// One camera as OpenCV spells it.
struct CvCamera {
  cv::Mat matrix, distortion;
};

CvCamera CalibrateOne(const StereoViews& views,
                      const std::vector<std::vector<cv::Point2f>>& images) {
  CvCamera camera;
  std::vector<cv::Mat> turns, shifts;
  cv::calibrateCamera(views.boards, images, views.size, camera.matrix, camera.distortion, turns,
                      shifts);
  return camera;
}

RigCamera FromCv(const CvCamera& camera, const cv::Size& size) {
  RigCamera result;
  result.width_px = size.width;
  result.height_px = size.height;
  CameraModel& model = result.model;
  model.fx_px = camera.matrix.at<double>(0, 0);
  model.fy_px = camera.matrix.at<double>(1, 1);
  model.cx_px = camera.matrix.at<double>(0, 2);
  model.cy_px = camera.matrix.at<double>(1, 2);
  double* const coefficients[] = {&model.k1, &model.k2, &model.p1, &model.p2, &model.k3};
  for (int i = 0; i < 5; ++i) *coefficients[i] = camera.distortion.at<double>(i);
  return result;
}

}  // namespace

Rig CalibrateWithOpenCv(const StereoViews& views, int flags) {
  CvCamera left = CalibrateOne(views, views.left);
  CvCamera right = CalibrateOne(views, views.right);
  cv::Matx33d turn, essential, fundamental;
  cv::Vec3d shift;
  // As many steps as it takes: the default stops after 30.
  const cv::TermCriteria until(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-9);
  cv::stereoCalibrate(views.boards, views.left, views.right, left.matrix, left.distortion,
                      right.matrix, right.distortion, views.size, turn, shift, essential,
                      fundamental, flags, until);
  Rig rig{{FromCv(left, views.size), FromCv(right, views.size)}, {}};
  const Eigen::Matrix3d matrix = Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turn.val);
  rig.cameras[1].cam_from_world = {Eigen::Quaterniond(matrix), {shift[0], shift[1], shift[2]}};
  return rig;
}

}  // namespace stereomotion::testing
