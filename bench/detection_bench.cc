// Measures detection and the whole pair beside one pass of cv::threshold and OpenCV's
// SimpleBlobDetector, on the same images, in the same run, on one thread. See docs/performance.md.
#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/ratio_reporter.h"
#include "bench/scene.h"
#include "src/detection/background_map.h"
#include "src/detection/ball_fitter.h"
#include "src/detection/classify_blob.h"
#include "src/detection/segment_blobs.h"
#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/pipeline/pose_tracker.h"
#include "stereomotion/simulation/render_scene.h"

namespace stereomotion::bench {
namespace {

/// Everything that the benchmarks share: one pair of a scene of ten balls, one of twenty.
struct Data {
  explicit Data(int rods) : scene(MakeScene(rods)) {
    for (int camera = 0; camera < 2; ++camera) {
      RenderSceneImage(scene, camera, 0, images[camera]);
      const ImageView view = images[camera].View();
      mats[camera] =
          cv::Mat(view.height_px, view.width_px, CV_8UC1, const_cast<std::uint8_t*>(view.data),
                  static_cast<std::size_t>(view.stride_bytes));
    }
  }
  Scenario scene;
  Image images[2];
  cv::Mat mats[2];
};

const Data& TenBalls() {
  static const Data data(2);
  return data;
}

const Data& TwentyBalls() {
  static const Data data(4);
  return data;
}

void CvThreshold(benchmark::State& state) {
  cv::Mat out;
  for (auto _ : state) {
    cv::threshold(TenBalls().mats[0], out, 60, 255, cv::THRESH_BINARY);
    benchmark::DoNotOptimize(out.data);
  }
}

void CvSimpleBlobDetector(benchmark::State& state) {
  cv::SimpleBlobDetector::Params params;
  params.minThreshold = 50;
  params.maxThreshold = 110;
  params.thresholdStep = 50;
  params.minRepeatability = 1;
  params.filterByColor = true;
  params.blobColor = 255;
  params.minArea = 10;
  const auto detector = cv::SimpleBlobDetector::create(params);
  std::vector<cv::KeyPoint> points;
  for (auto _ : state) {
    detector->detect(TenBalls().mats[0], points);
    benchmark::DoNotOptimize(points.data());
  }
  if (points.size() != 10) state.SkipWithError("SimpleBlobDetector did not find the ten balls");
}

void SegmentTenBalls(benchmark::State& state) {
  const DetectionOptions options;
  const SensorNoise noise = TenBalls().scene.sensor.noise();
  BackgroundMap background;
  Segmenter segmenter;
  const ImageView view = TenBalls().images[0].View();
  for (auto _ : state) {
    EstimateBackground(view, noise, options.max_diameter_px, background);
    segmenter.Segment(view, background, options.threshold_sigma);
    benchmark::DoNotOptimize(segmenter.blobs().data());
  }
  if (segmenter.blobs().size() != 10) state.SkipWithError("not ten blobs");
}

void FitTenBalls(benchmark::State& state) {
  const DetectionOptions options;
  const SensorNoise noise = TenBalls().scene.sensor.noise();
  BackgroundMap background;
  Segmenter segmenter;
  BallFitter fitter;
  const ImageView view = TenBalls().images[0].View();
  EstimateBackground(view, noise, options.max_diameter_px, background);
  segmenter.Segment(view, background, options.threshold_sigma);
  for (auto _ : state) {
    for (const Blob& blob : segmenter.blobs()) {
      benchmark::DoNotOptimize(fitter.Fit(view, segmenter, blob, noise).chi2);
    }
  }
}

void Detect(benchmark::State& state, const Data& data, std::size_t expected) {
  BallDetector detector(data.scene.sensor.noise());
  std::vector<BallObservation> balls;
  for (auto _ : state) {
    detector.Detect(data.images[0].View(), balls);
    benchmark::DoNotOptimize(balls.data());
  }
  if (balls.size() != expected) state.SkipWithError("wrong number of balls");
}

void DetectTenBalls(benchmark::State& state) { Detect(state, TenBalls(), 10); }
void DetectTwentyBalls(benchmark::State& state) { Detect(state, TwentyBalls(), 20); }

void WholePair(benchmark::State& state, const Data& data) {
  BallDetector detector(data.scene.sensor.noise());
  PoseTracker tracker(data.scene.rig.cameras[0], data.scene.rig.cameras[1], data.scene.body);
  std::vector<BallObservation> left;
  std::vector<BallObservation> right;
  std::int64_t time_ns = 0;
  bool found = false;
  for (auto _ : state) {
    detector.Detect(data.images[0].View(), left);
    detector.Detect(data.images[1].View(), right);
    time_ns += 1000000;
    found = tracker.Track(time_ns, left, right).has_value();
  }
  if (!found) state.SkipWithError("no pose");
}

void WholePairTenBalls(benchmark::State& state) { WholePair(state, TenBalls()); }
void WholePairTwentyBalls(benchmark::State& state) { WholePair(state, TwentyBalls()); }

BENCHMARK(CvThreshold);
BENCHMARK(CvSimpleBlobDetector);
BENCHMARK(SegmentTenBalls);
BENCHMARK(FitTenBalls);
BENCHMARK(DetectTenBalls);
BENCHMARK(DetectTwentyBalls);
BENCHMARK(WholePairTenBalls);
BENCHMARK(WholePairTwentyBalls);

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  // 51 interleaved repetitions unless the command line says otherwise: it comes later and wins.
  std::vector<char*> arguments = {argv[0]};
  char repetitions[] = "--benchmark_repetitions=51";
  char interleaving[] = "--benchmark_enable_random_interleaving=true";
  char time[] = "--benchmark_min_time=0.02";
  for (char* argument : {repetitions, interleaving, time}) arguments.push_back(argument);
  for (int i = 1; i < argc; ++i) arguments.push_back(argv[i]);
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  stereomotion::bench::RatioReporter reporter("CvThreshold");
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return 0;
}
