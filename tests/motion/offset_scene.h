#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/motion_data.h"
#include "tests/support/synthetic_scene.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {

using Path = std::function<Rigid3(double)>;

inline constexpr double kRateHz = 30, kSigmaPx = 0.02;
inline constexpr double kExact = 1e-12;  // px²: a rig that is known, and says so

/// A handful of balls swung through the cameras' view: 0.6 Hz, up to 300 mm/s and 1.5 rad/s. Its
/// fifth derivative leaves the interpolation's error at 6 ms below 0.001 px.
inline Rigid3 Swing(double t) {
  const double w = 2 * M_PI * 0.6;
  return {ExpSO3({0.4 * std::sin(w * t), 0.3 * std::cos(w * t), 0.2 * std::sin(w * t + 1)}),
          Eigen::Vector3d(60 * std::sin(w * t), 80 * std::cos(w * t), 40 * std::sin(w * t + 2))};
}

/// Makes what two cameras see of a path, the right one `offset_s` late; exact for σ = 0 of noise.
inline MotionData See(const Path& path, int frames, double offset_s, double noise,
                      std::mt19937_64& rng) {
  MotionData data;
  data.rig = MakeConvergingRig();
  data.rig.covariance = RigCovariance{{{0, 0}}, Eigen::MatrixXd::Constant(1, 1, kExact)};
  for (const Rod& rod : MakeTwoRodBody().rods) {
    data.balls_in_body_mm.insert(data.balls_in_body_mm.end(), rod.balls_in_body_mm.begin(),
                                 rod.balls_in_body_mm.end());
  }
  for (int i = 0; i < frames; ++i) {
    MotionFrame frame;
    frame.pose.frame = i;
    frame.pose.timestamp_ns = std::llround(1e9 * i / kRateHz);
    frame.pose.measured = true;
    frame.pose.world_from_body = path(i / kRateHz);
    for (int camera = 0; camera < 2; ++camera) {
      const Rigid3 pose = path(i / kRateHz + (camera == 1 ? offset_s : 0));
      for (std::size_t b = 0; b < data.balls_in_body_mm.size(); ++b) {
        ImagePoint point{
            camera, static_cast<int>(b), {}, kSigmaPx * kSigmaPx * Eigen::Matrix2d::Identity()};
        point.center_px = *ProjectWorldPoint(data.rig.cameras[static_cast<std::size_t>(camera)],
                                             pose * data.balls_in_body_mm[b]) +
                          noise * kSigmaPx * NormalVector<2>(rng);
        frame.image_points.push_back(point);
      }
    }
    data.frames.push_back(frame);
  }
  return data;
}

}  // namespace stereomotion::testing
