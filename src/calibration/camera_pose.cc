#include "camera_pose.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {

namespace {

struct Correspondences {
  std::vector<cv::Point3d> objects;
  std::vector<cv::Point2d> images;  // normalised
};

Correspondences Collect(const CameraModel& model, const std::vector<BundlePoint>& points,
                        const std::vector<BundleObservation>& observations) {
  Correspondences found;
  for (const auto& observation : observations) {
    const auto ray = model.Unproject(observation.pixel_px);
    if (!ray) continue;
    const Eigen::Vector3d& p_mm = points[observation.point].xyz_mm;
    found.objects.emplace_back(p_mm.x(), p_mm.y(), p_mm.z());
    found.images.emplace_back(ray->x(), ray->y());
  }
  return found;
}

Rigid3 ToRigid(const cv::Vec3d& rotation, const cv::Vec3d& translation) {
  return {ExpSO3({rotation[0], rotation[1], rotation[2]}),
          {translation[0], translation[1], translation[2]}};
}

bool AllBefore(const Rigid3& cam_from_target, const std::vector<BundlePoint>& points,
               const std::vector<BundleObservation>& observations) {
  return std::all_of(observations.begin(), observations.end(), [&](const auto& o) {
    return (cam_from_target * points[o.point].xyz_mm).z() > 0;
  });
}

constexpr std::size_t kLeastPoints = 4;

}  // namespace

std::optional<Rigid3> FindCameraPose(const CameraModel& model,
                                     const std::vector<BundlePoint>& points,
                                     const std::vector<BundleObservation>& observations,
                                     bool flat) {
  const Correspondences found = Collect(model, points, observations);
  if (found.objects.size() < kLeastPoints) return std::nullopt;
  cv::Vec3d rotation, translation;
  const int method = flat ? cv::SOLVEPNP_IPPE : cv::SOLVEPNP_SQPNP;
  try {
    if (!cv::solvePnP(found.objects, found.images, cv::Matx33d::eye(), {}, rotation, translation,
                      false, method)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {  // OpenCV's answer to points that determine nothing
    return std::nullopt;
  }
  const Rigid3 pose = ToRigid(rotation, translation);
  return AllBefore(pose, points, observations) ? std::optional(pose) : std::nullopt;
}

std::optional<Rigid3> FindCameraPoseRobustly(const CameraModel& model,
                                             const std::vector<BundlePoint>& points,
                                             const std::vector<BundleObservation>& observations,
                                             double tolerance_px) {
  constexpr int kTrials = 300;
  constexpr double kConfidence = 0.999;
  const Correspondences found = Collect(model, points, observations);
  if (found.objects.size() <= kLeastPoints) return std::nullopt;
  cv::Vec3d rotation, translation;
  try {
    if (!cv::solvePnPRansac(found.objects, found.images, cv::Matx33d::eye(), {}, rotation,
                            translation, false, kTrials,
                            static_cast<float>(tolerance_px / model.fx_px), kConfidence)) {
      return std::nullopt;
    }
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  const Rigid3 pose = ToRigid(rotation, translation);
  return AllBefore(pose, points, observations) ? std::optional(pose) : std::nullopt;
}

}  // namespace stereomotion
