#include "body_trackers.h"

#include <algorithm>
#include <utility>

#include "pose/verify_pose.h"

namespace stereomotion {
namespace {

constexpr int kNobody = -1;

bool ShareDetection(const PoseFix& a, const PoseFix& b) {
  return std::any_of(a.used.begin(), a.used.end(), [&](const BallAssignment& x) {
    return std::any_of(b.used.begin(), b.used.end(), [&](const BallAssignment& y) {
      return x.camera == y.camera && x.detection == y.detection;
    });
  });
}

}  // namespace

BodyTrackers::BodyTrackers(const MeasureSetup& setup, const TrackerOptions& options)
    : fixes_(setup.bodies.size(), Unexpected{PoseStatus::kLost}),
      states_(setup.bodies.size(), State::kOpen) {
  const auto& cameras = setup.rig.cameras;
  for (const Body& body : setup.bodies) {
    trackers_.emplace_back(cameras[static_cast<std::size_t>(setup.left_camera)],
                           cameras[static_cast<std::size_t>(setup.right_camera)], body, options);
  }
}

const std::vector<Expected<PoseFix, PoseStatus>>& BodyTrackers::Track(
    std::int64_t timestamp_ns, const std::vector<BallObservation>& left_balls,
    const std::vector<BallObservation>& right_balls) {
  if (trackers_.size() == 1) {
    fixes_[0] = trackers_[0].Track(timestamp_ns, left_balls, right_balls);
    return fixes_;
  }
  const Balls balls{&left_balls, &right_balls};
  std::fill(states_.begin(), states_.end(), State::kOpen);
  for (std::size_t camera : {0, 1}) owner_[camera].assign(balls[camera]->size(), kNobody);
  FollowAll(timestamp_ns, balls);
  SettleFound();
  // Each round settles at least one body or is the last.
  while (std::find(states_.begin(), states_.end(), State::kOpen) != states_.end()) {
    SearchOpen(timestamp_ns, balls);
    if (SettleFound()) OpenAmbiguous();
  }
  AcceptAll(timestamp_ns, balls);
  return fixes_;
}

void BodyTrackers::FollowAll(std::int64_t timestamp_ns, const Balls& balls) {
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    auto followed = trackers_[body].Follow(timestamp_ns, *balls[0], *balls[1]);
    if (!followed) continue;
    fixes_[body] = std::move(*followed);
    states_[body] = State::kFound;
  }
}

void BodyTrackers::SearchOpen(std::int64_t timestamp_ns, const Balls& balls) {
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    if (states_[body] != State::kOpen) continue;
    const Balls left_over = LeaveTo(body, balls);
    fixes_[body] = trackers_[body].Search(timestamp_ns, *left_over[0], *left_over[1]);
    states_[body] = fixes_[body] ? State::kFound : State::kSettled;
    if (!fixes_[body] || left_over == balls) continue;
    for (BallAssignment& used : fixes_[body]->used) {
      used.detection = rest_index_[static_cast<std::size_t>(used.camera)]
                                  [static_cast<std::size_t>(used.detection)];
    }
  }
}

bool BodyTrackers::Loses(std::size_t body) const {
  for (std::size_t other = 0; other < trackers_.size(); ++other) {
    if (other == body || states_[other] != State::kFound) continue;
    if (!ShareDetection(*fixes_[body], *fixes_[other])) continue;
    if (ExplainsMore(*fixes_[other], *fixes_[body])) return true;
    // Equal in number and χ², which no two measurements are: somebody has to have them.
    if (!ExplainsMore(*fixes_[body], *fixes_[other]) && other < body) return true;
  }
  return false;
}

bool BodyTrackers::SettleFound() {
  losers_.clear();
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    if (states_[body] == State::kFound && Loses(body)) losers_.push_back(body);
  }
  for (const std::size_t body : losers_) states_[body] = State::kOpen;
  bool settled = false;
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    if (states_[body] != State::kFound) continue;
    settled = true;
    states_[body] = State::kSettled;
    for (const BallAssignment& used : fixes_[body]->used) {
      owner_[static_cast<std::size_t>(used.camera)][static_cast<std::size_t>(used.detection)] =
          static_cast<int>(body);
    }
  }
  return settled;
}

void BodyTrackers::OpenAmbiguous() {
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    const auto& fix = fixes_[body];
    if (!fix && fix.error() == PoseStatus::kAmbiguous) states_[body] = State::kOpen;
  }
}

BodyTrackers::Balls BodyTrackers::LeaveTo(std::size_t body, const Balls& balls) {
  const auto others = [&](int owner) {
    return owner != kNobody && owner != static_cast<int>(body);
  };
  const auto any = [&](const std::vector<int>& owners) {
    return std::any_of(owners.begin(), owners.end(), others);
  };
  if (!any(owner_[0]) && !any(owner_[1])) return balls;
  for (std::size_t camera : {0, 1}) {
    rest_[camera].clear();
    rest_index_[camera].clear();
    for (std::size_t i = 0; i < balls[camera]->size(); ++i) {
      if (others(owner_[camera][i])) continue;
      rest_[camera].push_back((*balls[camera])[i]);
      rest_index_[camera].push_back(static_cast<int>(i));
    }
  }
  return {&rest_[0], &rest_[1]};
}

void BodyTrackers::AcceptAll(std::int64_t timestamp_ns, const Balls& balls) {
  for (std::size_t body = 0; body < trackers_.size(); ++body) {
    if (!fixes_[body]) continue;
    const Balls own = LeaveTo(body, balls);
    fixes_[body] = trackers_[body].Accept(timestamp_ns, std::move(*fixes_[body]), *own[0], *own[1]);
  }
}

}  // namespace stereomotion
