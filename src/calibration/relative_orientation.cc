#include "relative_orientation.h"

#include <opencv2/calib3d.hpp>

namespace stereomotion {
namespace {

constexpr std::size_t kLeastPoints = 16;  // twice what an eight-point start needs
constexpr double kRansacPx = 3;

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
  const cv::Matx33d normalized = cv::Matx33d::eye();
  cv::Mat inliers;
  cv::theRNG().state = 1;  // OpenCV's sampling reads it: same input, same result
  const cv::Mat essential =
      cv::findEssentialMat(first_rays, second_rays, normalized, cv::RANSAC, 0.999,
                           kRansacPx / first.fx_px, most_samples, inliers);
  if (essential.rows != 3) return std::nullopt;
  cv::Matx33d rotation;
  cv::Vec3d translation;
  const int before = cv::recoverPose(essential, first_rays, second_rays, normalized, rotation,
                                     translation, inliers);
  if (before < static_cast<int>(kLeastPoints)) return std::nullopt;
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = rotation.val[i];
  return Rigid3{Eigen::Quaterniond(matrix).normalized(),
                {translation[0], translation[1], translation[2]}};
}

}  // namespace stereomotion
