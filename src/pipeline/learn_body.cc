#include "stereomotion/pipeline/learn_body.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "learn_points.h"
#include "learn_shape.h"
#include "motion/find_lone_rod.h"
#include "refine_learned.h"
#include "stereomotion/pipeline/motion_data_of.h"

namespace stereomotion {
namespace {

const RigCamera& CameraOf(const MeasureSetup& setup, int camera) {
  const int index = camera == 0 ? setup.left_camera : setup.right_camera;
  if (index < 0 || index >= static_cast<int>(setup.rig.cameras.size())) {
    throw std::invalid_argument("LearnBodies needs two cameras of the rig");
  }
  return setup.rig.cameras[static_cast<std::size_t>(index)];
}

bool HasEnoughBalls(const std::vector<PointCloud>& frames, const GroupOptions& options) {
  const auto least = static_cast<std::size_t>(options.match.min_points);
  const auto enough = std::count_if(frames.begin(), frames.end(),
                                    [&](const PointCloud& frame) { return frame.size() >= least; });
  return enough >= options.min_frames;
}

/// Measures the recording with the bodies found so far, which also sees balls that were hidden from
/// one camera or partly, and refines them on all of that.
bool RefineOnRun(const PairSource& source, MeasureSetup setup, const MeasureOptions& options,
                 const std::vector<int>& frames_so_far, LearnedBodies& learned,
                 const std::atomic<bool>* stop, const std::function<void()>& each_pair) {
  setup.bodies = learned.bodies;
  std::vector<PairMeasurement> measurements;
  const auto sink = [&](const PairMeasurement& measurement) {
    measurements.push_back(measurement);
    measurements.back().left.clear();  // the detections themselves, which nobody needs
    measurements.back().right.clear();
    if (each_pair && measurement.body == 0) each_pair();
    return true;
  };
  if (MeasureRecording(source, setup, options, sink, stop).interrupted) return false;
  for (std::size_t i = 0; i < setup.bodies.size(); ++i) {
    Body& body = learned.bodies[i];
    MotionData data = MotionDataOf(setup, measurements, static_cast<int>(i));
    data.structure_known = false;
    data.structure_covariance_mm2.resize(0, 0);
    const auto found = std::count_if(data.frames.begin(), data.frames.end(),
                                     [](const auto& frame) { return frame.pose.measured; });
    // Less than before: the tracker refuses the body, and the first answer is the better one.
    if (found * 2 < frames_so_far[i]) {
      learned.warnings.push_back(body.name + ": found again in only " + std::to_string(found) +
                                 " pairs");
      continue;
    }
    if (!RefineBodyAndLag(data, body, learned.warnings) && body.covariance_mm2.size() == 0) {
      learned.warnings.push_back(body.name +
                                 ": its geometry could not be refined; it is only rough");
    }
  }
  return true;
}

bool AnyMoves(const std::vector<BallGroup>& groups) {
  return std::any_of(groups.begin(), groups.end(),
                     [](const BallGroup& group) { return group.moves; });
}

/// A rod alone is sought where no other body moves.
std::vector<BallGroup> FindGroups(const std::vector<PointCloud>& frames,
                                  const GroupOptions& options) {
  std::vector<BallGroup> groups = GroupBalls(frames, options);
  if (AnyMoves(groups)) return groups;
  if (auto rod = FindLoneRod(frames, options)) groups.push_back(std::move(*rod));
  return groups;
}

/// One body, with all that the first round knows of it.
struct FirstRound {
  LearnedShape shape;
  const BallGroup* group = nullptr;
};

/// Three things that rest on a line are no rod yet; five are the design.
bool HasFullRod(const Body& body) {
  constexpr std::size_t kDesign = 5;
  return std::any_of(body.rods.begin(), body.rods.end(),
                     [](const Rod& rod) { return rod.balls_in_body_mm.size() >= kDesign; });
}

std::vector<FirstRound> FindShapes(const std::vector<BallGroup>& groups, bool moving,
                                   const std::vector<LearnPair>& pairs, const MeasureSetup& setup,
                                   double diameter_mm) {
  std::vector<FirstRound> shapes;
  for (const BallGroup& group : groups) {
    if (group.moves != moving) continue;
    auto shape = ShapeOf(group, pairs, CameraOf(setup, 0), CameraOf(setup, 1), diameter_mm);
    if (shape && (moving || HasFullRod(shape->body))) {
      shapes.push_back({std::move(*shape), &group});
    }
  }
  std::stable_sort(shapes.begin(), shapes.end(), [](const FirstRound& a, const FirstRound& b) {
    const auto place = [](const FirstRound& x) {
      const auto first =
          std::find_if(x.shape.world_from_body.begin(), x.shape.world_from_body.end(),
                       [](const auto& pose) { return pose.has_value(); });
      return (*first)->translation_mm.x();
    };
    return std::make_tuple(-static_cast<double>(a.shape.group_balls.size()), place(a)) <
           std::make_tuple(-static_cast<double>(b.shape.group_balls.size()), place(b));
  });
  return shapes;
}

void NameBodies(std::vector<FirstRound>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i].shape.body.name = shapes.size() == 1 ? "body" : "body" + std::to_string(i + 1);
  }
}

LearnedBodies RefineFirst(const std::vector<FirstRound>& shapes,
                          const std::vector<LearnPair>& pairs, const MeasureSetup& setup,
                          bool moving) {
  LearnedBodies learned;
  for (const FirstRound& first : shapes) {
    Body body = first.shape.body;
    if (!moving)
      learned.warnings.push_back(body.name + ": nothing moves; it may be a part of the background");
    if (first.shape.left_over > 0) {
      learned.warnings.push_back(body.name + ": " + std::to_string(first.shape.left_over) +
                                 " balls that lie on no rod are left out");
    }
    std::vector<std::string> replaced;  // by what the second round says
    RefineBody(ObservationsOfShape(first.shape, *first.group, pairs, setup), body, replaced);
    learned.bodies.push_back(std::move(body));
  }
  return learned;
}

}  // namespace

Expected<LearnedBodies, LearnBodyFailure> LearnBodies(const PairSource& source,
                                                      const MeasureSetup& setup,
                                                      const LearnBodyOptions& options,
                                                      const std::atomic<bool>* stop,
                                                      const std::function<void()>& each_pair) {
  const RigCamera &left = CameraOf(setup, 0), &right = CameraOf(setup, 1);
  MeasureOptions measure = options.measure;
  measure.count =
      measure.count < 0 ? options.max_pairs : std::min(measure.count, options.max_pairs);
  const auto pairs = DetectPairs(source, setup, measure, stop, each_pair);
  if (!pairs) return Unexpected{LearnBodyFailure::kInterrupted};
  if (static_cast<std::int64_t>(pairs->size()) < kFewestPairsToLearn) {
    return Unexpected{LearnBodyFailure::kTooFewPairs};
  }
  const LearnedPoints points = FindPoints(*pairs, left, right);
  GroupOptions grouping;
  grouping.min_frames = static_cast<int>(kFewestPairsToLearn);
  if (!HasEnoughBalls(points.frames, grouping)) return Unexpected{LearnBodyFailure::kTooFewBalls};
  const std::vector<BallGroup> groups = FindGroups(points.frames, grouping);
  if (groups.empty()) return Unexpected{LearnBodyFailure::kNoGroup};
  const bool moving = AnyMoves(groups);
  auto shapes = FindShapes(groups, moving, *pairs, setup, options.ball_diameter_mm);
  if (shapes.empty()) {
    return Unexpected{moving ? LearnBodyFailure::kNoGroup : LearnBodyFailure::kNoMotion};
  }
  NameBodies(shapes);
  LearnedBodies learned = RefineFirst(shapes, *pairs, setup, moving);
  std::vector<int> found;
  for (const FirstRound& first : shapes) found.push_back(first.group->CountFrames());
  if (!RefineOnRun(source, setup, measure, found, learned, stop, each_pair)) {
    return Unexpected{LearnBodyFailure::kInterrupted};
  }
  return learned;
}

}  // namespace stereomotion
