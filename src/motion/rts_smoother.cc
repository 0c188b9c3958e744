#include "motion/rts_smoother.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

using Matrix12d = MotionState::Covariance;
using Vector12d = Eigen::Matrix<double, 12, 1>;

Matrix12d ProcessNoise(double dt_s, const MotionNoise& noise) {
  Vector6d psd;
  psd << Eigen::Vector3d::Constant(noise.rotation_rad2_s3),
      Eigen::Vector3d::Constant(noise.translation_mm2_s3);
  Matrix12d q = Matrix12d::Zero();
  q.topLeftCorner<6, 6>() = (dt_s * dt_s * dt_s / 3 * psd).asDiagonal();
  q.topRightCorner<6, 6>() = (dt_s * dt_s / 2 * psd).asDiagonal();
  q.bottomLeftCorner<6, 6>() = q.topRightCorner<6, 6>();
  q.bottomRightCorner<6, 6>() = (dt_s * psd).asDiagonal();
  return q;
}

/// Moves a state on by dt; returns the transition of its perturbation.
Matrix12d Predict(double dt_s, const MotionNoise& noise, MotionState& state) {
  const Eigen::Vector3d turn = dt_s * state.omega_rad_s;
  const Eigen::Quaterniond step = ExpSO3(turn);
  Matrix12d f = Matrix12d::Identity();
  f.block<3, 3>(0, 0) = step.toRotationMatrix();
  f.block<3, 3>(0, 6) = dt_s * LeftJacobianSO3(turn);
  f.block<3, 3>(3, 9) = dt_s * Eigen::Matrix3d::Identity();
  state.world_from_body.rotation = (step * state.world_from_body.rotation).normalized();
  state.world_from_body.translation_mm += dt_s * state.velocity_mm_s;
  state.covariance = (f * state.covariance * f.transpose() + ProcessNoise(dt_s, noise)).eval();
  return f;
}

void Perturb(const Vector12d& delta, MotionState& state) {
  state.world_from_body = stereomotion::Perturb(state.world_from_body, delta.head<6>());
  state.omega_rad_s += delta.segment<3>(6);
  state.velocity_mm_s += delta.tail<3>();
}

Vector12d Difference(const MotionState& from, const MotionState& to) {
  Vector12d delta;
  delta << PerturbationBetween(from.world_from_body, to.world_from_body),
      to.omega_rad_s - from.omega_rad_s, to.velocity_mm_s - from.velocity_mm_s;
  return delta;
}

/// Finds what a measured pose is worth; along a free axis nothing.
Matrix6d MeasurementNoise(const PoseSample& sample) {
  constexpr double kUnknownRad2 = 1e4;  // 100 rad: a turn more or less tells nothing
  Matrix6d covariance = sample.covariance;
  if (sample.free_axis_in_world) {
    const Eigen::Vector3d& axis = *sample.free_axis_in_world;
    covariance.topLeftCorner<3, 3>() += kUnknownRad2 * axis * axis.transpose();
  }
  return covariance;
}

/// Corrects a state by a measured pose; returns −2 ln of its likelihood but for a constant.
double Correct(const PoseSample& sample, MotionState& state) {
  const Matrix6d noise = MeasurementNoise(sample);
  const Vector6d innovation = PerturbationBetween(state.world_from_body, sample.world_from_body);
  const Matrix6d s = state.covariance.topLeftCorner<6, 6>() + noise;
  const Eigen::LDLT<Matrix6d> factor(s);
  const Eigen::Matrix<double, 12, 6> gain = factor.solve(state.covariance.topRows<6>()).transpose();
  Matrix12d keep = Matrix12d::Identity();
  keep.leftCols<6>() -= gain;
  // Joseph's form: stays positive though the start is nearly unknown.
  state.covariance =
      (keep * state.covariance * keep.transpose() + gain * noise * gain.transpose()).eval();
  Perturb(gain * innovation, state);
  return factor.vectorD().array().log().sum() + innovation.dot(factor.solve(innovation));
}

/// Starts at the first pose with rates from the next one and nearly no trust in them.
MotionState Start(const PoseSeries& series, std::size_t first, std::size_t last) {
  constexpr double kBeyondDoubt = 300;  // × the largest rate seen: weighs 1e-5 of one interval
  std::size_t next = first + 1;
  while (next < last && !series[next].measured) ++next;
  const double dt_s = SecondsAfterFirst(series, next) - SecondsAfterFirst(series, first);
  const Vector6d step =
      PerturbationBetween(series[first].world_from_body, series[next].world_from_body);
  const Matrix6d noise = series[first].covariance;
  const double turn = step.head<3>().norm() + std::sqrt(noise.topLeftCorner<3, 3>().trace());
  const double way = step.tail<3>().norm() + std::sqrt(noise.bottomRightCorner<3, 3>().trace());
  MotionState state{series[first].world_from_body, step.head<3>() / dt_s, step.tail<3>() / dt_s,
                    Matrix12d::Zero()};
  state.covariance.topLeftCorner<6, 6>() = MeasurementNoise(series[first]);
  const double turn_rate = kBeyondDoubt * turn / dt_s, way_rate = kBeyondDoubt * way / dt_s;
  state.covariance.block<3, 3>(6, 6).diagonal().setConstant(turn_rate * turn_rate);
  state.covariance.block<3, 3>(9, 9).diagonal().setConstant(way_rate * way_rate);
  return state;
}

/// Holds what the backward pass needs of the forward one, a sample each.
struct ForwardPass {
  std::vector<MotionState> predicted, corrected;
  std::vector<Matrix12d> transitions;  ///< from the sample before
  double misfit = 0;
};

ForwardPass RunForward(const PoseSeries& series, std::size_t first, std::size_t last,
                       const MotionNoise& noise) {
  ForwardPass pass;
  MotionState state = Start(series, first, last);
  pass.predicted = pass.corrected = {state};
  pass.transitions = {Matrix12d::Identity()};
  int corrections = 1;
  for (std::size_t i = first + 1; i <= last; ++i) {
    const double dt_s = SecondsAfterFirst(series, i) - SecondsAfterFirst(series, i - 1);
    pass.transitions.push_back(Predict(dt_s, noise, state));
    pass.predicted.push_back(state);
    if (series[i].measured) {
      const double misfit = Correct(series[i], state);
      if (++corrections > 2) pass.misfit += misfit;
    }
    pass.corrected.push_back(state);
  }
  return pass;
}

}  // namespace

std::vector<MotionState> SmoothSegment(const PoseSeries& series, std::size_t first,
                                       std::size_t last, const MotionNoise& noise) {
  const ForwardPass pass = RunForward(series, first, last, noise);
  std::vector<MotionState> smoothed = pass.corrected;
  for (std::size_t k = smoothed.size() - 1; k-- > 0;) {
    const MotionState& predicted = pass.predicted[k + 1];
    const Eigen::LDLT<Matrix12d> factor(predicted.covariance);
    const Matrix12d gain =
        factor.solve(pass.transitions[k + 1] * pass.corrected[k].covariance).transpose();
    Perturb(gain * Difference(predicted, smoothed[k + 1]), smoothed[k]);
    smoothed[k].covariance +=
        gain * (smoothed[k + 1].covariance - predicted.covariance) * gain.transpose();
    smoothed[k].covariance =
        (smoothed[k].covariance + smoothed[k].covariance.transpose()).eval() / 2;
  }
  return smoothed;
}

double InnovationMisfit(const PoseSeries& series, std::size_t first, std::size_t last,
                        const MotionNoise& noise) {
  return RunForward(series, first, last, noise).misfit;
}

}  // namespace stereomotion
