// Measures a whole calibration from images in memory: 20 views of an AprilTag grid by two cameras,
// detection on two threads. See docs/performance.md.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "stereomotion/calibration/calibrate.h"
#include "stereomotion/calibration/observe_target.h"
#include "tests/support/board_image.h"
#include "tests/support/calibration_scene.h"

namespace stereomotion::bench {
namespace {

constexpr int kViews = 20;
constexpr int kCameras = 2;
constexpr int kThreads = 2;

/// The images of one calibration, camera by camera; rendering them takes longer than all the rest.
struct Capture {
  Capture() : scene(testing::MakeBoardScene(kViews)) {
    testing::BoardImageOptions options;
    options.noise = SensorNoise{};
    for (int i = 0; i < kCameras * kViews; ++i) {
      const RigCamera& camera = scene.truth.cameras[CameraOf(i)];
      options.width_px = camera.width_px;
      options.height_px = camera.height_px;
      options.seed = static_cast<std::uint64_t>(i) + 1;
      images.push_back(testing::RenderBoard(
          scene.setup.target, camera.model,
          camera.cam_from_world * scene.world_from_target[ViewOf(i)], options));
    }
  }
  static std::size_t CameraOf(int image) { return static_cast<std::size_t>(image / kViews); }
  static std::size_t ViewOf(int image) { return static_cast<std::size_t>(image % kViews); }

  testing::CalibrationScene scene;
  std::vector<Image> images;
};

const Capture& TagViews() {
  static const Capture capture;
  return capture;
}

std::vector<TargetObservation> Observe(const Capture& capture) {
  const int count = static_cast<int>(capture.images.size());
  std::vector<TargetSight> sights(capture.images.size());
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      const ObservedImage which{i / kViews, i % kViews, {}, {}};
      const auto at = static_cast<std::size_t>(i);
      sights[at] = ObserveTarget(capture.images[at].View(), capture.scene.setup.target, which);
    }
  };
  std::vector<std::thread> threads;
  for (int i = 1; i < kThreads; ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  std::vector<TargetObservation> observations;
  for (const TargetSight& sight : sights) {
    observations.insert(observations.end(), sight.observations.begin(), sight.observations.end());
  }
  return observations;
}

void DetectTags(benchmark::State& state) {
  const Capture& capture = TagViews();
  std::size_t corners = 0;
  for (auto _ : state) corners = Observe(capture).size();
  state.counters["corners"] = static_cast<double>(corners);
}

void CalibrateFromTags(benchmark::State& state) {
  const Capture& capture = TagViews();
  CalibrateOptions options;
  options.image_sigma_known = false;
  double error_px = 1e300;
  for (auto _ : state) {
    const auto calibration = Calibrate(capture.scene.setup, Observe(capture), options);
    if (!calibration) return state.SkipWithError(calibration.error().text.c_str());
    error_px = std::abs(calibration->rig.cameras[0].model.fx_px -
                        capture.scene.truth.cameras[0].model.fx_px);
  }
  state.counters["focal_error_px"] = error_px;
  if (!(error_px < 1)) state.SkipWithError("the calibration is wrong");
}

// Seconds, not microseconds: few repetitions will do. The wall clock: two threads work.
BENCHMARK(DetectTags)->Unit(benchmark::kSecond)->UseRealTime()->Repetitions(5);
BENCHMARK(CalibrateFromTags)->Unit(benchmark::kSecond)->UseRealTime()->Repetitions(5);

}  // namespace
}  // namespace stereomotion::bench

BENCHMARK_MAIN();
