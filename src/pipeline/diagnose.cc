#include "diagnose.h"

#include <algorithm>

#include "stereomotion/pose/acquire_pose.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion {
namespace {

const RigCamera& CameraAt(const MeasureSetup& setup, int index) {
  return setup.rig.cameras[static_cast<std::size_t>(index)];
}

bool AnyPose(const RigCamera& left, const RigCamera& right, const Body& body,
             const std::vector<FailedPair>& pairs, const AcquireOptions& options) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const FailedPair& pair) {
    return AcquirePose(left, right, body, pair.left, pair.right, {}, options).has_value();
  });
}

std::size_t CountCandidates(const RigCamera& left, const RigCamera& right, double radius_mm,
                            const std::vector<FailedPair>& pairs, const MatchOptions& options) {
  std::size_t count = 0;
  std::vector<StereoCandidate> candidates;
  for (const FailedPair& pair : pairs) {
    FindStereoCandidates(left, right, pair.left, pair.right, radius_mm, options, candidates);
    count += candidates.size();
  }
  return count;
}

Body Scaled(const Body& body, double factor) {
  Body scaled = body;
  for (Rod& rod : scaled.rods) {
    rod.ball_diameter_mm *= factor;
    for (Eigen::Vector3d& ball : rod.balls_in_body_mm) ball *= factor;
  }
  return scaled;
}

std::string SwappedMessage(const RigCamera& left, const RigCamera& right) {
  return "the cameras are swapped: with the left images taken by '" + right.name +
         "' and the right ones by '" + left.name +
         "' the body is found. Exchange --left and --right, or the folders' names";
}

std::string Short(double number) {
  std::string text = std::to_string(number);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string Count(std::size_t n, const char* what) { return std::to_string(n) + " " + what; }

}  // namespace

std::string DiagnoseFailure(const MeasureSetup& setup, const Body& body,
                            const MeasureOptions& options, const std::vector<FailedPair>& pairs) {
  const RigCamera& left = CameraAt(setup, setup.left_camera);
  const RigCamera& right = CameraAt(setup, setup.right_camera);
  std::size_t seen_left = 0;
  std::size_t seen_right = 0;
  for (const FailedPair& pair : pairs) {
    seen_left += pair.left.size();
    seen_right += pair.right.size();
  }
  if (seen_left == 0 || seen_right == 0) {
    return "no balls were detected in the " + std::string(seen_left == 0 ? "left" : "right") +
           " images of the first pairs: check light, focus and exposure";
  }
  // Swapped on purpose: would the exchanged cameras do better?
  // NOLINTNEXTLINE(readability-suspicious-call-argument)
  if (AnyPose(right, left, body, pairs, options.tracker.acquire))
    return SwappedMessage(left, right);
  for (const double factor : {1000.0, 0.001, 10.0, 0.1, 25.4}) {
    if (!AnyPose(left, right, Scaled(body, factor), pairs, options.tracker.acquire)) continue;
    return "the body file's lengths are in the wrong unit: multiplied by " + Short(factor) +
           " they fit the images (lengths are in millimetres)";
  }
  const double radius_mm = body.rods.front().ball_diameter_mm / 2;
  const MatchOptions& match = options.tracker.acquire.match;
  const std::size_t found = CountCandidates(left, right, radius_mm, pairs, match);
  // NOLINTNEXTLINE(readability-suspicious-call-argument)
  if (found == 0) {
    return Count(seen_left, "balls in the left and ") +
           Count(seen_right, "in the right images have no epipolar match: ") +
           "the rig file does not belong to these cameras, or a camera was moved after calibration";
  }
  return Count(found,
               "ball matches between the cameras, but no rod of the body file fits them: check "
               "the distances between the balls in the body file, and the rig's scale");
}

}  // namespace stereomotion
