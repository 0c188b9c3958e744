#include "motion/weight_row.h"

#include <algorithm>
#include <cmath>

#include "motion/rotation_chart.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Columns = Eigen::Matrix3d;  // value, first and second derivative side by side

/// Sums Σ h τ over a row: what the filter makes of time itself (0, 1, 0 but at the ends).
Eigen::RowVector3d FilteredTime(const RotationChart& chart, const WeightRow& row) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (int i = 0; i < row.weights.rows(); ++i) sum += chart.Tau(row.first + i) * row.weights.row(i);
  return sum;
}

/// Sums the weighted translations, relative to the first one so that no digits are lost.
Columns FilteredTranslation(const PoseSeries& series, const FilterSegment& segment,
                            const WeightRow& row) {
  const auto at = [&](int i) -> const Eigen::Vector3d& {
    return series[segment.measured[row.first + i]].world_from_body.translation_mm;
  };
  Columns sum = Columns::Zero();
  for (int i = 1; i < row.weights.rows(); ++i) sum += (at(i) - at(0)) * row.weights.row(i);
  sum.col(0) += at(0);
  return sum;
}

/// Holds Σ h_a C_s h_b for the derivatives a, b = 0, 1, 2; each 6×6, order (rotation, translation).
struct RowCovariance {
  Matrix6d blocks[3][3];
};

Vector6d WeightsOf(const WeightRow& rotation, const WeightRow& translation, int k, int derivative) {
  const auto weight = [&](const WeightRow& row) {
    const int i = k - row.first;
    return i >= 0 && i < row.weights.rows() ? row.weights(i, derivative) : 0.0;
  };
  Vector6d weights;
  weights << Eigen::Vector3d::Constant(weight(rotation)),
      Eigen::Vector3d::Constant(weight(translation));
  return weights;
}

RowCovariance Propagate(const PoseSeries& series, const FilterSegment& segment,
                        const RotationChart& chart, const WeightRow& rotation,
                        const WeightRow& translation) {
  RowCovariance sum;
  for (auto& row : sum.blocks) std::fill(std::begin(row), std::end(row), Matrix6d::Zero());
  const int first = std::min(rotation.first, translation.first);
  const int last = std::max(rotation.first + static_cast<int>(rotation.weights.rows()),
                            translation.first + static_cast<int>(translation.weights.rows()));
  for (int k = first; k < last; ++k) {
    Matrix6d unturn = Matrix6d::Identity();
    unturn.topLeftCorner<3, 3>() = chart.Unturn(k).toRotationMatrix();
    const Matrix6d c = unturn * series[segment.measured[k]].covariance * unturn.transpose();
    for (int a = 0; a < 3; ++a) {
      for (int b = a == 0 ? 0 : 1; b < (a == 0 ? 1 : 3); ++b) {
        sum.blocks[a][b] += WeightsOf(rotation, translation, k, a).asDiagonal() * c *
                            WeightsOf(rotation, translation, k, b).asDiagonal();
      }
    }
  }
  return sum;
}

/// Lays the blocks of first and second derivative out as (ω, v, α, a); `turn` carries the chart's
/// rotation rates to world axes, α = turn ξ̈ + ω̄ × turn ξ̇.
Eigen::Matrix<double, 12, 12> VelocityCovariance(const RowCovariance& rows,
                                                 const Eigen::Matrix3d& turn,
                                                 const Eigen::Vector3d& rate_rad_s) {
  Eigen::Matrix<double, 12, 12> raw;
  raw << rows.blocks[1][1], rows.blocks[1][2], rows.blocks[2][1], rows.blocks[2][2];
  Eigen::Matrix<double, 12, 12> map = Eigen::Matrix<double, 12, 12>::Identity();
  map.block<3, 3>(0, 0) = turn;
  map.block<3, 3>(6, 6) = turn;
  map.block<3, 3>(6, 0) = Hat(rate_rad_s) * turn;
  return map * raw * map.transpose();
}

/// Takes a rotation that nothing determines out of the covariances, as the poses themselves do.
void ProjectFreeAxis(FilteredSample& sample) {
  const Eigen::Vector3d& axis = *sample.pose.free_axis_in_world;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  Matrix6d pose = Matrix6d::Identity();
  pose.topLeftCorner<3, 3>() = across;
  sample.pose.covariance = pose * sample.pose.covariance * pose;
  Eigen::Matrix<double, 12, 12> rates = Eigen::Matrix<double, 12, 12>::Identity();
  rates.block<3, 3>(0, 0) = across;
  rates.block<3, 3>(6, 6) = across;
  sample.velocity.covariance = rates * sample.velocity.covariance * rates;
}

}  // namespace

FilteredSample ApplyWeights(const PoseSeries& series, const FilterSegment& segment,
                            std::size_t index, const WeightRow& rotation,
                            const WeightRow& translation) {
  const double time_s = SecondsAfterFirst(series, index);
  const RotationChart chart(series, segment, time_s, rotation);
  const Columns xi = chart.Sum(rotation);
  const Eigen::RowVector3d time = FilteredTime(chart, rotation);
  const Columns t_mm = FilteredTranslation(series, segment, translation);
  const PoseSample& nearest = series[segment.measured[NearestPose(segment, time_s)]];

  FilteredSample out;
  out.status = series[index].measured ? MotionStatus::kOk : MotionStatus::kFilled;
  out.pose = nearest;  // its calibration part and free axis
  out.pose.frame = series[index].frame;
  out.pose.timestamp_ns = series[index].timestamp_ns;
  const Eigen::Quaterniond carried = ExpSO3(time[0] * chart.rate_rad_s());
  const Eigen::Quaterniond rotated = carried * ExpSO3(xi.col(0)) * chart.anchor_rotation();
  out.pose.world_from_body = {WithPositiveW(rotated.normalized()), t_mm.col(0)};

  const Eigen::Matrix3d turn = LeftJacobianSO3(xi.col(0));
  BodyVelocity& v = out.velocity;
  v.status = out.status;
  v.has_acceleration = true;
  v.window = static_cast<int>(std::max(rotation.weights.rows(), translation.weights.rows()));
  v.omega_rad_s = time[1] * chart.rate_rad_s() + turn * xi.col(1);
  v.alpha_rad_s2 =
      time[2] * chart.rate_rad_s() + turn * xi.col(2) + chart.rate_rad_s().cross(turn * xi.col(1));
  v.velocity_mm_s = t_mm.col(1);
  v.acceleration_mm_s2 = t_mm.col(2);

  const RowCovariance rows = Propagate(series, segment, chart, rotation, translation);
  out.pose.covariance = rows.blocks[0][0];
  v.covariance = VelocityCovariance(rows, turn, chart.rate_rad_s());
  if (out.pose.free_axis_in_world) {
    *out.pose.free_axis_in_world =
        (rotated * nearest.world_from_body.rotation.conjugate()) * *out.pose.free_axis_in_world;
    ProjectFreeAxis(out);
  }
  return out;
}

}  // namespace stereomotion
