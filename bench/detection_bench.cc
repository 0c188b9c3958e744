// Measures detection and the whole pair beside one pass of cv::threshold and OpenCV's
// SimpleBlobDetector, on the same images, in the same run, on one thread. See docs/performance.md.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "bench/frames.h"
#include "bench/ratio_reporter.h"
#include "src/detection/background_map.h"
#include "src/detection/ball_fitter.h"
#include "src/detection/edge_table.h"
#include "src/detection/segment_blobs.h"
#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/pipeline/pose_tracker.h"

namespace stereomotion::bench {
namespace {

using FramesOf = Frames& (*)();

cv::Mat MatOf(const ImageView& view) {
  return {view.height_px, view.width_px, CV_8UC1, const_cast<std::uint8_t*>(view.data),
          static_cast<std::size_t>(view.stride_bytes)};
}

void CvThreshold(benchmark::State& state, FramesOf frames) {
  cv::Mat out;
  for (auto _ : state) {
    cv::threshold(MatOf(frames().Next()), out, 60, 255, cv::THRESH_BINARY);
    benchmark::DoNotOptimize(out.data);
  }
}

void CvSimpleBlobDetector(benchmark::State& state, FramesOf frames) {
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
    detector->detect(MatOf(frames().Next()), points);
    benchmark::DoNotOptimize(points.data());
  }
  if (points.size() != 10) state.SkipWithError("SimpleBlobDetector did not find the ten balls");
}

void Segment(benchmark::State& state, FramesOf frames) {
  const DetectionOptions options;
  const SensorNoise noise = frames().noise();
  BackgroundMap background;
  Segmenter segmenter;
  for (auto _ : state) {
    const ImageView view = frames().Next();
    EstimateBackground(view, noise, options.max_diameter_px, background);
    segmenter.Segment(view, background, options.threshold_sigma);
    benchmark::DoNotOptimize(segmenter.blobs().data());
  }
  if (segmenter.blobs().size() != 10) state.SkipWithError("not ten blobs");
}

void FitTenBalls(benchmark::State& state, FramesOf frames) {
  const DetectionOptions options;
  const SensorNoise noise = frames().noise();
  BackgroundMap background;
  Segmenter segmenter;
  BallFitter fitter;
  const ImageView view = frames().Next();
  EstimateBackground(view, noise, options.max_diameter_px, background);
  segmenter.Segment(view, background, options.threshold_sigma);
  for (auto _ : state) {
    for (const Blob& blob : segmenter.blobs()) {
      benchmark::DoNotOptimize(fitter.Fit(view, segmenter, blob, noise).chi2);
    }
  }
}

void Detect(benchmark::State& state, FramesOf frames, DetectorMethod method) {
  DetectionOptions options;
  options.method = method;
  BallDetector detector(frames().noise(), options);
  std::vector<BallObservation> balls;
  for (auto _ : state) {
    detector.Detect(frames().Next(), balls);
    benchmark::DoNotOptimize(balls.data());
  }
  const std::size_t expected = 5 * frames().scene().body.rods.size();
  if (balls.size() != expected) state.SkipWithError("wrong number of balls");
}

/// Finds each frame's balls, as windows for the next frame.
std::vector<std::vector<SearchWindow>> WindowsOf(Frames& frames) {
  constexpr int kReach_px = 12;
  std::vector<std::vector<SearchWindow>> windows(frames.count());
  BallDetector detector(frames.noise());
  std::vector<BallObservation> balls;
  for (std::size_t i = 0; i < frames.count(); ++i) {
    detector.Detect(frames.Next(), balls);
    for (const BallObservation& ball : balls) {
      const int u = static_cast<int>(ball.center_px.x());
      const int v = static_cast<int>(ball.center_px.y());
      windows[frames.current()].push_back(
          {u - kReach_px, u + kReach_px, v - kReach_px, v + kReach_px, ball});
    }
  }
  return windows;
}

/// Tracking: every ball has a window around its place in the frame before (the first frame's: in
/// the same frame).
void DetectInWindows(benchmark::State& state, FramesOf frames, DetectorMethod method) {
  DetectionOptions options;
  options.method = method;
  BallDetector detector(frames().noise(), options);
  std::vector<BallObservation> balls;
  const auto windows = WindowsOf(frames());
  detector.Detect(frames().Next(), balls);
  for (auto _ : state) {
    const ImageView view = frames().Next();
    const std::size_t before = std::max(frames().current(), std::size_t{1}) - 1;
    detector.Detect(view, windows[before], balls);
    benchmark::DoNotOptimize(balls.data());
  }
  if (balls.size() != 10) state.SkipWithError("wrong number of balls");
}

void WholePair(benchmark::State& state, FramesOf frames) {
  const Scenario& scene = frames().scene();
  BallDetector detector(frames().noise());
  PoseTracker tracker(scene.rig.cameras[0], scene.rig.cameras[1], scene.body);
  std::vector<BallObservation> left;
  std::vector<BallObservation> right;
  std::int64_t time_ns = 0;
  bool found = false;
  for (auto _ : state) {
    detector.Detect(frames().Next(), left);
    detector.Detect(frames().Right(), right);
    time_ns += 1000000;
    found = tracker.Track(time_ns, left, right).has_value();
  }
  if (!found) state.SkipWithError("no pose");
}

constexpr auto kMl = DetectorMethod::kMaximumLikelihood;
constexpr auto kCentroid = DetectorMethod::kCentroid;
constexpr auto kWavelet = DetectorMethod::kWavelet;

BENCHMARK_CAPTURE(CvThreshold, hot, HotTenBalls);
BENCHMARK_CAPTURE(CvThreshold, streaming, StreamingTenBalls);
BENCHMARK_CAPTURE(CvSimpleBlobDetector, streaming, StreamingTenBalls);
BENCHMARK_CAPTURE(Segment, hot, HotTenBalls);
BENCHMARK_CAPTURE(Segment, streaming, StreamingTenBalls);
BENCHMARK_CAPTURE(FitTenBalls, hot, HotTenBalls);
BENCHMARK_CAPTURE(Detect, hot_ml, HotTenBalls, kMl);
BENCHMARK_CAPTURE(Detect, hot_ml_20_balls, HotTwentyBalls, kMl);
BENCHMARK_CAPTURE(Detect, hot_centroid, HotTenBalls, kCentroid);
BENCHMARK_CAPTURE(Detect, streaming_ml, StreamingTenBalls, kMl);
BENCHMARK_CAPTURE(Detect, streaming_centroid, StreamingTenBalls, kCentroid);
BENCHMARK_CAPTURE(Detect, streaming_wavelet, StreamingTenBalls, kWavelet);
BENCHMARK_CAPTURE(DetectInWindows, hot_ml, HotTenBalls, kMl);
BENCHMARK_CAPTURE(DetectInWindows, streaming_ml, StreamingTenBalls, kMl);
BENCHMARK_CAPTURE(DetectInWindows, streaming_centroid, StreamingTenBalls, kCentroid);
BENCHMARK_CAPTURE(WholePair, hot_10_balls, HotTenBalls);
BENCHMARK_CAPTURE(WholePair, hot_20_balls, HotTwentyBalls);

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  // Built once in a program's life: not to be counted among the first frame's instructions.
  stereomotion::EdgeTable::Get();
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
