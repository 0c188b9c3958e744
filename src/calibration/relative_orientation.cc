#include "relative_orientation.h"

#include <opencv2/calib3d.hpp>

namespace stereomotion {
namespace {

constexpr std::size_t kLeastPoints = 16;  // twice what an eight-point start needs
/// How far a point may lie from its epipolar line. Among images without mistakes the wide limit
/// takes the first orientation that comes along, however poor: then a narrow one finds a better.
constexpr double kRansacPx[] = {3, 0.3};

struct Oriented {
  Rigid3 second_from_first;
  int in_front = 0;  ///< points before both cameras
};

Oriented Orient(const std::vector<cv::Point2d>& first_rays,
                const std::vector<cv::Point2d>& second_rays, double threshold, int most_samples) {
  const cv::Matx33d normalized = cv::Matx33d::eye();
  cv::Mat inliers;
  cv::theRNG().state = 1;  // OpenCV's sampling reads it: same input, same result
  const cv::Mat essential = cv::findEssentialMat(first_rays, second_rays, normalized, cv::RANSAC,
                                                 0.999, threshold, most_samples, inliers);
  if (essential.rows != 3) return {};
  cv::Matx33d rotation;
  cv::Vec3d translation;
  Oriented oriented;
  oriented.in_front = cv::recoverPose(essential, first_rays, second_rays, normalized, rotation,
                                      translation, inliers);
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = rotation.val[i];
  oriented.second_from_first = {Eigen::Quaterniond(matrix).normalized(),
                                {translation[0], translation[1], translation[2]}};
  return oriented;
}

}  // namespace

std::optional<Rigid3> FindRelativeOrientation(const CameraModel& first, const CameraModel& second,
                                              const std::vector<PixelPair>& pairs,
                                              int most_samples) {
  std::vector<cv::Point2d> first_rays, second_rays;
  for (const PixelPair& pair : pairs) {
    const auto a = first.Unproject(pair.first_px);
    const auto b = second.Unproject(pair.second_px);
    if (!a || !b) continue;
    first_rays.emplace_back(a->x(), a->y());
    second_rays.emplace_back(b->x(), b->y());
  }
  if (first_rays.size() < kLeastPoints) return std::nullopt;
  Oriented best;
  for (const double limit_px : kRansacPx) {
    const Oriented found = Orient(first_rays, second_rays, limit_px / first.fx_px, most_samples);
    if (found.in_front > best.in_front) best = found;
  }
  if (best.in_front < static_cast<int>(kLeastPoints)) return std::nullopt;
  return best.second_from_first;
}

}  // namespace stereomotion
