#pragma once

#include <Eigen/Cholesky>
#include <functional>
#include <random>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/motion_data.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {

/// Draws a pose covariance that is neither isotropic nor block-diagonal: standard deviations within
/// a factor of 2 of the given ones, correlations of any size.
inline Matrix6d DrawPoseCovariance(std::mt19937_64& rng, double sigma_rad, double sigma_mm) {
  Matrix6d mix;
  for (int k = 0; k < 6; ++k) mix.col(k) = NormalVector<6>(rng) / 3;
  mix += Matrix6d::Identity();
  Vector6d sigma;
  for (int k = 0; k < 6; ++k) {
    sigma[k] = (k < 3 ? sigma_rad : sigma_mm) * Uniform(rng, 0.7, 1.4) / mix.row(k).norm();
  }
  return sigma.asDiagonal() * mix * mix.transpose() * sigma.asDiagonal();
}

/// Makes a series of exact poses, `pose` being a function of the time in s after the first.
inline PoseSeries ExactSeries(int frames, double rate_hz, const std::function<Rigid3(double)>& pose,
                              const std::function<Matrix6d()>& covariance) {
  PoseSeries series;
  for (int i = 0; i < frames; ++i) {
    PoseSample sample;
    sample.frame = i;
    sample.timestamp_ns = 1'000'000'000 + static_cast<std::int64_t>(1e9 * i / rate_hz);
    sample.measured = true;
    sample.world_from_body = pose(1e-9 * static_cast<double>(sample.timestamp_ns - 1'000'000'000));
    sample.covariance = covariance();
    series.push_back(sample);
  }
  return series;
}

/// Adds to every measured pose an error drawn from its covariance.
inline PoseSeries WithNoise(PoseSeries series, std::mt19937_64& rng) {
  for (PoseSample& sample : series) {
    if (!sample.measured) continue;
    const Vector6d error = sample.covariance.llt().matrixL() * NormalVector<6>(rng);
    sample.world_from_body = Perturb(sample.world_from_body, error);
  }
  return series;
}

/// Expresses a series in another world.
inline PoseSeries InOtherWorld(PoseSeries series, const Rigid3& other_from_world) {
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = other_from_world.rotation.toRotationMatrix();
  turn.bottomRightCorner<3, 3>() = turn.topLeftCorner<3, 3>();
  for (PoseSample& sample : series) {
    sample.world_from_body = other_from_world * sample.world_from_body;
    sample.covariance = turn * sample.covariance * turn.transpose();
  }
  return series;
}

/// Expresses a vector by two coordinates across a unit vector `a`: covariances of directions and of
/// places on axes have rank 2.
inline Eigen::Matrix<double, 2, 3> Across(const Eigen::Vector3d& a) {
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = a.unitOrthogonal().transpose();
  across.row(1) = a.cross(a.unitOrthogonal()).transpose();
  return across;
}

}  // namespace stereomotion::testing
