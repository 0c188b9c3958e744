#include "stereomotion/pipeline/learn_mask.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "erase_balls.h"
#include "image_size.h"
#include "lowest_levels.h"
#include "static_places.h"

namespace stereomotion {
namespace {

/// Beyond a ball's outline: the skirt of its blur, and a pixel of the 3×3 neighbourhood.
constexpr double kSkirt_px = 5;

const RigCamera& CameraOf(const MeasureSetup& setup, std::size_t camera) {
  return setup.rig
      .cameras[static_cast<std::size_t>(camera == 0 ? setup.left_camera : setup.right_camera)];
}

using BodyBalls = std::array<std::vector<BodyBall>, 2>;  ///< a camera

/// What was measured in the pairs that are looked at.
struct SeenBalls {
  std::vector<BodyBalls> body;
  std::array<std::vector<BallCenters>, 2> whole_px;  ///< of a camera, a pair
};

/// Where the pairs lie that are looked at.
std::vector<std::int64_t> SpreadPositions(std::int64_t first, std::int64_t size, int wanted) {
  std::vector<std::int64_t> positions;
  const std::int64_t count = std::min<std::int64_t>(size, wanted);
  for (std::int64_t i = 0; i < count; ++i) positions.push_back(first + i * size / count);
  return positions;
}

void AddBallsOfBody(const std::vector<MatchedDetection>& detections, std::vector<BodyBall>& balls) {
  for (const MatchedDetection& detection : detections) {
    if (detection.id.rod < 0) continue;
    const BallObservation& ball = detection.observation;
    balls.push_back({ball.center_px, ball.semi_major_px + kSkirt_px});
  }
}

void AddBallsOfBody(const PairMeasurement& measurement, BodyBalls& balls) {
  AddBallsOfBody(measurement.left, balls[0]);
  AddBallsOfBody(measurement.right, balls[1]);
}

BallCenters WholeBalls(const std::vector<MatchedDetection>& detections) {
  BallCenters centers_px;
  for (const MatchedDetection& detection : detections) {
    const BallObservation& ball = detection.observation;
    if (ball.status == BlobStatus::kOk) centers_px.push_back(ball.center_px);
  }
  return centers_px;
}

void AddWholeBalls(const PairMeasurement& measurement, SeenBalls& seen) {
  seen.whole_px[0].push_back(WholeBalls(measurement.left));
  seen.whole_px[1].push_back(WholeBalls(measurement.right));
}

/// Measures the recording; tells where balls are in the chosen pairs.
RunSummary FindBody(const PairSource& source, const MeasureSetup& setup,
                    const MeasureOptions& options, const std::vector<std::int64_t>& positions,
                    SeenBalls& seen, const std::function<void()>& each_pair,
                    const std::atomic<bool>* stop) {
  std::int64_t position = options.first;
  std::size_t next = 0;  // of `positions`
  bool wanted = false;
  seen.body.resize(positions.size());
  const MeasurementSink sink = [&](const PairMeasurement& measurement) {
    const bool first_body = measurement.body == 0;
    if (first_body) {
      wanted = next < positions.size() && positions[next] == position;
      ++position;
      if (wanted) AddWholeBalls(measurement, seen);
      if (wanted) ++next;
      if (each_pair) each_pair();
    }
    if (wanted) AddBallsOfBody(measurement, seen.body[next - 1]);
    return true;
  };
  return MeasureRecording(source, setup, options, sink, stop);
}

/// One camera's levels: of everything, and of all but the body.
struct CameraLevels {
  LowestLevels all, without_body;
  HighestBackground background;
  explicit CameraLevels(int count) : all(count), without_body(count) {}
};

void AddPair(const FramePair& pair, const MeasureSetup& setup, const BodyBalls& body_balls,
             const RunSummary& run, double max_ball_px, std::array<CameraLevels, 2>& levels) {
  for (const std::size_t i : {0, 1}) {
    const Frame& frame = i == 0 ? pair.left : pair.right;
    const RigCamera& camera =
        setup.rig
            .cameras[static_cast<std::size_t>(i == 0 ? setup.left_camera : setup.right_camera)];
    if (!HasSizeOf(camera, frame)) continue;
    Image brightest = BrightestNeighbours(frame.image.View());
    const SensorNoise& noise = (i == 0 ? run.noise_left : run.noise_right).noise;
    levels[i].background.Add(brightest.View(), noise, max_ball_px);
    levels[i].all.Add(brightest.View());
    Erase(body_balls[i], camera, brightest);
    levels[i].without_body.Add(brightest.View());
  }
}

void CheckOptions(const MaskOptions& options) {
  if (!(options.bright_share > 0 && options.bright_share <= 1) || options.pairs < 1 ||
      options.min_pairs < 1 || !(options.margin_px > 0) || options.resting_balls < 1) {
    throw std::invalid_argument("LearnMask: an option is out of range");
  }
}

/// How many values a pixel must be kept, so that it may be dark in the rest of the images.
int LevelsToKeep(const MaskOptions& options, std::size_t images) {
  constexpr double kRounding = 1e-9;
  const double may_be_dark = (1 - options.bright_share) * static_cast<double>(images);
  return 1 + static_cast<int>(may_be_dark + kRounding);
}

bool FindPlaces(const MeasureSetup& setup, const DetectionOptions& detection,
                const MaskOptions& options, const std::array<CameraLevels, 2>& levels,
                LearnedMask& learned) {
  bool body_rests = false;
  for (const std::size_t i : {0, 1}) {
    const NoiseRecord& record = i == 0 ? learned.run.noise_left : learned.run.noise_right;
    const auto find = [&](const LowestLevels& of) {
      return FindStaticPlaces(of.Highest(), levels[i].background, record.noise, CameraOf(setup, i),
                              detection, options.margin_px);
    };
    learned.masked[i] = find(levels[i].without_body);
    learned.resting_balls[i] =
        WithoutThose(find(levels[i].all), learned.masked[i], CameraOf(setup, i));
    body_rests =
        body_rests || static_cast<int>(learned.resting_balls[i].size()) >= options.resting_balls;
  }
  return !body_rests;
}

/// Where a body is hardly found, and some of what stands still looks like its balls.
bool MayMaskBody(const MeasureSetup& setup, const MaskOptions& options, const SeenBalls& seen,
                 const LearnedMask& learned) {
  const double few = (1 - options.bright_share) * static_cast<double>(learned.run.pairs_read);
  const auto hardly_found = [&](const BodySummary& body) {
    return static_cast<double>(body.poses) <= few;
  };
  const auto& bodies = learned.run.bodies;
  if (std::none_of(bodies.begin(), bodies.end(), hardly_found)) return false;
  const auto many = [&](std::size_t i) {
    return CountBallPlaces(learned.masked[i], seen.whole_px[i], CameraOf(setup, i)) >=
           options.resting_balls;
  };
  return many(0) || many(1);
}

}  // namespace

Expected<LearnedMask, MaskFailure> LearnMask(const PairSource& source, const MeasureSetup& setup,
                                             const MeasureOptions& options,
                                             const MaskOptions& mask_options,
                                             const std::atomic<bool>* stop,
                                             const std::function<void()>& each_pair) {
  CheckOptions(mask_options);
  const std::int64_t rest = std::max<std::int64_t>(0, source.size() - options.first);
  const std::int64_t size = options.count < 0 ? rest : std::min(rest, options.count);
  const auto positions = SpreadPositions(options.first, size, mask_options.pairs);
  LearnedMask learned;
  SeenBalls seen;
  learned.run = FindBody(source, setup, options, positions, seen, each_pair, stop);
  const auto refuse = [&](MaskProblem problem) {
    return Unexpected{MaskFailure{problem, learned.run}};
  };
  const int kept = LevelsToKeep(mask_options, positions.size());
  std::array<CameraLevels, 2> levels{CameraLevels(kept), CameraLevels(kept)};
  FramePair pair;
  for (std::size_t i = 0; i < positions.size() && !(stop != nullptr && *stop); ++i) {
    source.Read(positions[i], pair);
    AddPair(pair, setup, seen.body[i], learned.run, options.detection.max_diameter_px, levels);
  }
  learned.pairs = std::min(levels[0].all.images(), levels[1].all.images());
  if (learned.pairs < mask_options.min_pairs) return refuse(MaskProblem::kTooFewPairs);
  if (!FindPlaces(setup, options.detection, mask_options, levels, learned)) {
    return refuse(MaskProblem::kBodyAtRest);
  }
  if (MayMaskBody(setup, mask_options, seen, learned)) return refuse(MaskProblem::kMayBeBody);
  return learned;
}

}  // namespace stereomotion
