#include "stereomotion/pose/status_words.h"

#include <cassert>

namespace stereomotion {

std::string_view StatusWord(PoseStatus status) {
  switch (status) {
    case PoseStatus::kOk:
      return "ok";
    case PoseStatus::kNoPair:
      return "no_pair";
    case PoseStatus::kUnreadable:
      return "unreadable";
    case PoseStatus::kTooFewBalls:
      return "too_few_balls";
    case PoseStatus::kLost:
      return "lost";
    case PoseStatus::kAmbiguous:
      return "ambiguous";
    case PoseStatus::kRollUndetermined:
      return "roll_undetermined";
    case PoseStatus::kInconsistent:
      return "inconsistent";
    case PoseStatus::kDropped:
      return "dropped";
  }
  assert(false);
  return "";
}

std::string_view StatusWord(BallStatus status) {
  switch (status) {
    case BallStatus::kOk:
      return "ok";
    case BallStatus::kLeftOnly:
      return "left_only";
    case BallStatus::kRightOnly:
      return "right_only";
    case BallStatus::kNotSeen:
      return "not_seen";
    case BallStatus::kRejected:
      return "rejected";
    case BallStatus::kNoPose:
      return "no_pose";
  }
  assert(false);
  return "";
}

std::string_view StatusWord(BlobStatus status) {
  switch (status) {
    case BlobStatus::kOk:
      return "ok";
    case BlobStatus::kPartly:
      return "partly_hidden";
    case BlobStatus::kClipped:
      return "clipped";
    case BlobStatus::kSaturated:
      return "saturated";
    case BlobStatus::kPoorFit:
      return "poor_fit";
  }
  assert(false);
  return "";
}

}  // namespace stereomotion
