// Measures how long the joint fit of a recording takes and how that grows with the frames: all laws
// of the spin centre, 20 balls in two cameras, on centres without images. Prints a table.
// See docs/performance.md.
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "stereomotion/geometry/so3.h"
#include "stereomotion/motion/spin_center.h"
#include "tests/support/synthetic_scene.h"

namespace stereomotion::bench {
namespace {

constexpr int kRepetitions = 5;
constexpr int kBalls = 20;
constexpr double kSigma_px = 0.0033;

/// A body that precesses by 60° and 40° about a resting point while both cameras watch; each
/// frame's pose is off by more than its noise, as a start.
MotionData MakeRecording(int frames, bool structure_known) {
  std::mt19937_64 rng(1);
  std::normal_distribution<double> normal;
  MotionData data;
  data.rig = testing::MakeConvergingRig();
  data.structure_known = structure_known;
  for (int i = 0; i < kBalls; ++i) {
    data.balls_in_body_mm.push_back(60 * Eigen::Vector3d(normal(rng), normal(rng), normal(rng)));
  }
  const Eigen::Vector3d center_in_body_mm(20, -30, 10);
  for (int t = 0; t < frames; ++t) {
    const double phase = 2 * M_PI * t / frames;
    MotionFrame frame;
    frame.pose.frame = t;
    frame.pose.timestamp_ns = 10'000'000LL * t;
    frame.pose.measured = true;
    frame.pose.world_from_body.rotation =
        ExpSO3({0, 0.5 * std::sin(phase), 0}) * ExpSO3({0.35 * std::cos(2 * phase), 0, 0});
    frame.pose.world_from_body.translation_mm =
        -(frame.pose.world_from_body.rotation * center_in_body_mm);
    frame.pose.covariance.diagonal() << Eigen::Vector3d::Constant(1e-9),
        Eigen::Vector3d::Constant(1e-4);
    for (int camera = 0; camera < 2; ++camera) {
      for (int ball = 0; ball < kBalls; ++ball) {
        const auto place = ProjectWorldPoint(
            data.rig.cameras[static_cast<std::size_t>(camera)],
            frame.pose.world_from_body * data.balls_in_body_mm[static_cast<std::size_t>(ball)]);
        if (!place) continue;
        frame.image_points.push_back(
            {camera, ball, *place + kSigma_px * Eigen::Vector2d(normal(rng), normal(rng)),
             kSigma_px * kSigma_px * Eigen::Matrix2d::Identity()});
      }
    }
    Vector6d off;
    for (double& value : off) value = 1e-4 * normal(rng);
    frame.pose.world_from_body = Perturb(frame.pose.world_from_body, off);
    data.frames.push_back(frame);
  }
  return data;
}

/// Time of this thread, which other programs disturb less than the clock's.
double ProcessorTimeMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

double MedianMs(const MotionData& data) {
  std::vector<double> times_ms;
  for (int i = 0; i < kRepetitions; ++i) {
    const double begin_ms = ProcessorTimeMs();
    const SpinCenterResult result = FindSpinCenter(data);
    times_ms.push_back(ProcessorTimeMs() - begin_ms);
    if (!result.center) std::fprintf(stderr, "no centre: %s\n", result.verdict.c_str());
  }
  std::sort(times_ms.begin(), times_ms.end());
  return times_ms[kRepetitions / 2];
}

void Run() {
  std::printf("%-10s %7s %9s %12s\n", "structure", "frames", "ms", "ms/frame");
  for (const bool known : {true, false}) {
    for (const int frames : {150, 300, 600, 1200}) {
      const double ms = MedianMs(MakeRecording(frames, known));
      std::printf("%-10s %7d %9.1f %12.3f\n", known ? "known" : "unknown", frames, ms, ms / frames);
    }
  }
}

}  // namespace
}  // namespace stereomotion::bench

int main() { stereomotion::bench::Run(); }
