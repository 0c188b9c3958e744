#include <fmt/format.h>

#include <algorithm>

#include "check_look.h"

namespace stereomotion::app {
namespace {

constexpr double kDegPerRad = 57.29577951308232;

class SampledPairs : public PairSource {
 public:
  explicit SampledPairs(const std::vector<FramePair>& pairs) : pairs_(pairs) {}
  [[nodiscard]] std::int64_t size() const override {
    return static_cast<std::int64_t>(pairs_.size());
  }
  bool Read(std::int64_t position, FramePair& pair) const override {
    pair = pairs_[static_cast<std::size_t>(position)];
    return true;
  }

 private:
  const std::vector<FramePair>& pairs_;
};

std::string PoseText(const Rigid3& pose) {
  const Eigen::AngleAxisd turn(pose.rotation);
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm, turned by {:.1f} degrees",
                     pose.translation_mm.x(), pose.translation_mm.y(), pose.translation_mm.z(),
                     turn.angle() * kDegPerRad);
}

// Whole blobs that no body took.
double FalseBlobs(const std::vector<MatchedDetection>& detections) {
  return static_cast<double>(
      std::count_if(detections.begin(), detections.end(), [](const MatchedDetection& blob) {
        return blob.id.rod < 0 && blob.observation.status == BlobStatus::kOk;
      }));
}

class BodySums {
 public:
  explicit BodySums(std::size_t bodies) : bodies_(bodies) {}

  void Add(const PairMeasurement& measurement, BodyLook& look) {
    // One body's detections are all the others': what is matched in one is unmatched in the next.
    if (bodies_ == 1) {
      false_blobs_ += FalseBlobs(measurement.left) + FalseBlobs(measurement.right);
      images_ += 2;
    }
    if (!measurement.pose) return;
    ++with_pose_;
    used_[0] += measurement.pose->balls_left;
    used_[1] += measurement.pose->balls_right;
    if (look.first_pose.empty()) look.first_pose = PoseText(measurement.pose->world_from_body);
  }

  void Write(BodyLook& look) const {
    look.false_blobs = images_ > 0 ? false_blobs_ / images_ : 0;
    const double pairs = with_pose_ / static_cast<double>(bodies_);
    if (pairs > 0) look.used_balls = {used_[0] / pairs, used_[1] / pairs};
  }

 private:
  std::size_t bodies_;
  double false_blobs_ = 0, images_ = 0, with_pose_ = 0;
  std::array<double, 2> used_{};
};

}  // namespace

BodyLook MeasureSamples(const Samples& samples, const MeasureSetup& setup) {
  BodyLook look;
  for (const Body& body : setup.bodies) {
    for (const Rod& rod : body.rods) {
      look.expected_balls += static_cast<std::int64_t>(rod.balls_in_body_mm.size());
    }
  }
  BodySums sums(setup.bodies.size());
  const SampledPairs source(samples.pairs);
  const RunSummary summary =
      MeasureRecording(source, setup, {}, [&](const PairMeasurement& measurement) {
        sums.Add(measurement, look);
        return true;
      });
  sums.Write(look);
  look.pairs = summary.pairs_read;
  look.poses = summary.poses;
  look.lost_by_reason = summary.lost_by_reason;
  look.median_chi2_dof = summary.median_chi2_dof;
  for (const std::string& warning : summary.warnings) {
    if (warning.find("the cameras are swapped") != std::string::npos) look.swapped = warning;
  }
  return look;
}

}  // namespace stereomotion::app
