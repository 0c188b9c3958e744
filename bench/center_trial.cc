#include "bench/center_trial.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "bench/axis_baselines.h"
#include "bench/center_baselines.h"
#include "bench/cluster_poses.h"
#include "stereomotion/core/units.h"
#include "stereomotion/motion/joint.h"
#include "stereomotion/motion/screw_axis.h"
#include "stereomotion/motion/spin_center.h"

namespace stereomotion::bench {
namespace {

constexpr char kCenter[] = "center_mm", kDirection[] = "axis_deg", kPlace[] = "axis_mm";
constexpr double kNoAnswer = std::numeric_limits<double>::infinity();

void AddBaselineCenter(const char* method, const Eigen::Vector3d& error_mm,
                       std::vector<TrialError>& errors) {
  errors.push_back({kCenter, method, true, error_mm.norm(), std::nullopt, 0});
}

void AddOwnCenter(const char* method, const Eigen::Vector3d& error_mm,
                  const Eigen::Matrix3d& covariance_mm2, std::vector<TrialError>& errors) {
  const double nees = error_mm.dot(covariance_mm2.ldlt().solve(error_mm));
  errors.push_back({kCenter, method, false, error_mm.norm(), nees, 3});
}

/// Markers, and poses of the segment, in the frame in which the centre rests.
void AddCenterBaselines(const MarkerSeries& markers_mm, const std::vector<Rigid3>& poses,
                        const Eigen::Vector3d& truth_mm, std::vector<TrialError>& errors) {
  const Eigen::Vector3d algebraic_mm = FitSpheresAlgebraic(markers_mm);
  AddBaselineCenter("spheres, geometric", FitSpheresGeometric(markers_mm, algebraic_mm) - truth_mm,
                    errors);
  AddBaselineCenter("spheres, algebraic", algebraic_mm - truth_mm, errors);
  AddBaselineCenter("spheres, bias-corrected", FitSpheresBiasCorrected(markers_mm) - truth_mm,
                    errors);
  AddBaselineCenter("pivot least squares", PivotLeastSquares(poses) - truth_mm, errors);
}

SpinCenterResult FindFixedCenter(const MotionData& data) {
  SpinCenterOptions options;
  options.law = PathLaw::kFixed;
  options.only_given_law = true;
  options.with_calibration = false;
  return FindSpinCenter(data, options);
}

void AddSpinCenter(const char* method, const MotionData& data, std::vector<TrialError>& errors) {
  const SpinCenterResult found = FindFixedCenter(data);
  if (!found.center || found.center->free_axis_in_body) {
    errors.push_back({kCenter, method, false, kNoAnswer, std::nullopt, 3});
    return;
  }
  const CenterState& state = found.center->states.front();
  AddOwnCenter(method, state.position_mm - TrueCenter_mm(), state.covariance.topLeftCorner<3, 3>(),
               errors);
}

std::vector<TrialError> RunBall(const MarkerTrial& trial, double sigma_mm) {
  std::vector<TrialError> errors;
  const ClusterPoses poses = AlignCluster(trial.moving_mm);
  AddCenterBaselines(trial.moving_mm, poses.world_from_shape, TrueCenter_mm(), errors);
  MotionData data = DataOf(trial.moving_mm, poses, sigma_mm);
  AddSpinCenter("stereomotion", data, errors);
  for (MotionFrame& frame : data.frames) frame.space_points.clear();
  AddSpinCenter("stereomotion, poses only", data, errors);
  return errors;
}

/// Centres in the base segment's mean shape, in which the truth is its best alignment with the
/// true markers.
std::vector<TrialError> RunBothMoving(const MarkerTrial& trial, const MarkerScene& scene) {
  std::vector<TrialError> errors;
  const ClusterPoses moving = AlignCluster(trial.moving_mm), base = AlignCluster(trial.base_mm);
  const Eigen::Vector3d truth_mm =
      AlignPoints(BaseCluster_mm(scene.base_distance_mm), base.shape_mm) * TrueCenter_mm();
  MarkerSeries relative_mm;
  std::vector<Rigid3> base_from_moving;
  for (std::size_t t = 0; t < trial.moving_mm.size(); ++t) {
    const Rigid3 base_from_world = base.world_from_shape[t].Inverse();
    base_from_moving.push_back(base_from_world * moving.world_from_shape[t]);
    relative_mm.emplace_back(
        (base_from_world.rotation.toRotationMatrix() * trial.moving_mm[t]).colwise() +
        base_from_world.translation_mm);
  }
  AddCenterBaselines(relative_mm, base_from_moving, truth_mm, errors);
  AddBaselineCenter("SCoRE", Score(moving.world_from_shape, base.world_from_shape) - truth_mm,
                    errors);
  const auto joint = FindJoint(SeriesOf(moving, scene.sigma_mm), SeriesOf(base, scene.sigma_mm));
  if (joint && !joint->free_axis_in_first) {
    AddOwnCenter("stereomotion", joint->center_in_second_mm - truth_mm,
                 joint->center_covariance_mm2.bottomRightCorner<3, 3>(), errors);
  } else {
    errors.push_back({kCenter, "stereomotion", false, kNoAnswer, std::nullopt, 3});
  }
  return errors;
}

/// Where the true axis is nearest to the middle of the cluster's way.
Eigen::Vector3d FootOnAxis_mm() {
  const Eigen::Vector3d cluster_mm = MovingCluster_mm().rowwise().mean();
  return TrueCenter_mm() + TrueAxis() * TrueAxis().dot(cluster_mm);
}

/// Drops what lies along the true axis.
Eigen::Vector2d Across(const Eigen::Vector3d& v) { return v.tail<2>(); }

double Nees2(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d across = covariance.bottomRightCorner<2, 2>();
  return Across(error).dot(across.ldlt().solve(Across(error)));
}

void AddAxis(const char* method, bool is_baseline, const AxisLine& axis,
             std::optional<double> direction_nees, std::vector<TrialError>& errors) {
  const double sine = axis.direction.cross(TrueAxis()).norm();
  errors.push_back(
      {kDirection, method, is_baseline, kDegreesPerRadian * std::asin(sine), direction_nees, 2});
  const double distance_mm = axis.direction.cross(FootOnAxis_mm() - axis.point_mm).norm();
  errors.push_back({kPlace, method, is_baseline, distance_mm, std::nullopt, 2});
}

/// That the motion is a hinge's is given, as the law of a centre is.
void AddMeanAxis(const PoseSeries& series, std::vector<TrialError>& errors) {
  constexpr char kMethod[] = "stereomotion";
  const auto mean = FindMeanAxis(series, Eigen::Vector3d::Zero(), AxisMotion::kHinge);
  if (!mean) {
    errors.push_back({kDirection, kMethod, false, kNoAnswer, std::nullopt, 2});
    errors.push_back({kPlace, kMethod, false, kNoAnswer, std::nullopt, 2});
    return;
  }
  const Eigen::Vector3d& direction = mean->line_direction;
  const Eigen::Vector3d truth = direction.dot(TrueAxis()) < 0 ? -TrueAxis() : TrueAxis();
  AddAxis(kMethod, false, {direction, mean->point_in_world_mm},
          Nees2(direction - truth, mean->line_direction_covariance), errors);
  errors.back().nees = Nees2(mean->point_in_world_mm - FootOnAxis_mm(), mean->point_covariance_mm2);
}

/// The spin centre of a hinge is known across its axis.
void AddHingeCenter(const MotionData& data, std::vector<TrialError>& errors) {
  constexpr char kMethod[] = "stereomotion, centre";
  const SpinCenterResult found = FindFixedCenter(data);
  if (!found.center) {
    errors.push_back({kPlace, kMethod, false, kNoAnswer, std::nullopt, 2});
    return;
  }
  const CenterState& state = found.center->states.front();
  const Eigen::Vector3d error_mm = state.position_mm - FootOnAxis_mm();
  errors.push_back({kPlace, kMethod, false, Across(error_mm).norm(),
                    Nees2(error_mm, state.covariance.topLeftCorner<3, 3>()), 2});
}

std::vector<TrialError> RunHinge(const MarkerTrial& trial, double sigma_mm) {
  std::vector<TrialError> errors;
  const ClusterPoses poses = AlignCluster(trial.moving_mm);
  const AxisLine sara = Sara(poses.world_from_shape);
  AddAxis("circles, geometric", true, FitCircles(trial.moving_mm, sara), std::nullopt, errors);
  AddAxis("SARA", true, sara, std::nullopt, errors);
  AddAxis("mean helical axis", true, MeanHelicalAxis(poses.world_from_shape), std::nullopt, errors);
  AddMeanAxis(SeriesOf(poses, sigma_mm), errors);
  AddHingeCenter(DataOf(trial.moving_mm, poses, sigma_mm), errors);
  return errors;
}

}  // namespace

std::vector<TrialError> RunTrial(const MarkerScene& scene, std::mt19937_64& rng) {
  const MarkerTrial trial = DrawTrial(scene, rng);
  switch (scene.kind) {
    case JointKind::kBall:
      return RunBall(trial, scene.sigma_mm);
    case JointKind::kBallBothMoving:
      return RunBothMoving(trial, scene);
    case JointKind::kHinge:
      break;
  }
  return RunHinge(trial, scene.sigma_mm);
}

}  // namespace stereomotion::bench
