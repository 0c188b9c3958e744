#include "calibration/label_from_rods.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "calibration/flatness.h"
#include "calibration/target_rods.h"
#include "stereomotion/calibration/find_collinear_balls.h"

namespace stereomotion {
namespace {

/// Rods with more points than this are not all tried: two or three that are found suffice.
constexpr std::size_t kMostRods = 6;
/// Places tried for each rod, best fit first (both directions of a symmetrical rod count).
constexpr std::size_t kMostPlaces = 10;
constexpr std::size_t kMostGrown = 40;
/// What a camera without distortion, principal point in the middle, may miss at exact blobs.
constexpr double kModelSigma_px = 1.5;
constexpr double kLargestRms_px = 8;
/// A labelling that explains less than this share of the points in the image is chance.
constexpr double kSmallestShare = 0.6;
/// A rival that explains this share of the winner's balls, as well or nearly so, makes it a guess.
constexpr double kRivalShare = 0.9;
constexpr double kRivalRms = 3;
/// Fits better than this differ by chance.
constexpr double kBlobSigma_px = 0.1;

struct PlacedRod {
  int rod = 0;
  std::vector<PointImage> points;
};

class RodLabeller {
 public:
  RodLabeller(std::vector<Eigen::Vector3d> points_mm, const std::vector<Eigen::Vector2d>& blobs_px,
              int width_px, int height_px)
      : points_mm_(std::move(points_mm)),
        blobs_px_(blobs_px),
        width_px_(width_px),
        height_px_(height_px) {}

  void Place(const std::vector<TargetRod>& rods) {
    for (std::size_t r = 0; r < std::min(rods.size(), kMostRods); ++r) {
      const auto found = FindCollinearBalls(blobs_px_, rods[r].distances_mm);
      for (std::size_t k = 0; k < std::min(found.size(), kMostPlaces); ++k) {
        PlacedRod placed{static_cast<int>(r), {}};
        for (std::size_t b = 0; b < found[k].points.size(); ++b) {
          placed.points.push_back({points_mm_[rods[r].points[b]], blobs_px_[found[k].points[b]]});
        }
        placed_.push_back(std::move(placed));
      }
    }
  }

  void Propose() {
    for (std::size_t a = 0; a < placed_.size(); ++a) {
      for (std::size_t b = a + 1; b < placed_.size(); ++b) {
        if (placed_[a].rod == placed_[b].rod) continue;
        auto points = Joined(placed_[a].points, placed_[b]);
        if (!IsFlat(points)) {
          Try(points);
          continue;
        }
        for (std::size_t c = b + 1; c < placed_.size(); ++c) {
          if (placed_[c].rod == placed_[a].rod || placed_[c].rod == placed_[b].rod) continue;
          auto all = Joined(points, placed_[c]);
          if (!IsFlat(all)) Try(all);
        }
      }
    }
    std::stable_sort(cameras_.begin(), cameras_.end(),
                     [](const auto& x, const auto& y) { return x.rms_px < y.rms_px; });
  }

  /// Grows the best cameras; best labelling first.
  std::vector<Labelling> Grow() const {
    std::vector<Labelling> grown;
    for (std::size_t i = 0; i < std::min(cameras_.size(), kMostGrown); ++i) {
      Labelling labelling = GrowLabels(points_mm_, blobs_px_, cameras_[i]);
      const auto same = [&](const Labelling& other) {
        return other.blob_of_point == labelling.blob_of_point;
      };
      if (std::none_of(grown.begin(), grown.end(), same)) grown.push_back(std::move(labelling));
    }
    std::stable_sort(grown.begin(), grown.end(), [](const Labelling& x, const Labelling& y) {
      return x.num_labelled != y.num_labelled ? x.num_labelled > y.num_labelled
                                              : x.camera.rms_px < y.camera.rms_px;
    });
    return grown;
  }

 private:
  static std::vector<PointImage> Joined(std::vector<PointImage> points, const PlacedRod& rod) {
    points.insert(points.end(), rod.points.begin(), rod.points.end());
    return points;
  }

  static bool IsFlat(const std::vector<PointImage>& points) {
    std::vector<Eigen::Vector3d> places;
    for (const PointImage& p : points) places.push_back(p.p_mm);
    return AreFlat(places);
  }

  void Try(const std::vector<PointImage>& points) {
    const auto camera = StartCamera(points, width_px_, height_px_, kModelSigma_px);
    if (camera && camera->rms_px < kLargestRms_px) cameras_.push_back(*camera);
  }

  std::vector<Eigen::Vector3d> points_mm_;
  const std::vector<Eigen::Vector2d>& blobs_px_;
  int width_px_, height_px_;
  std::vector<PlacedRod> placed_;
  std::vector<LabelCamera> cameras_;
};

LabelProblem NotIdentifiable(std::string text) {
  return {LabelFailure::kNotIdentifiable, {}, std::move(text)};
}

/// Survey errors of a line's points: three σ; unknown ones are taken for half a millimetre.
double ToleranceOf(const Target& target) {
  double sigma_mm = 0;
  for (const TargetPoint& point : target.points) sigma_mm = std::max(sigma_mm, point.sigma_mm);
  return std::max(0.5, 3 * sigma_mm);
}

/// Takes the best labelling if it explains enough and no rival explains nearly as much.
Expected<Labelling, LabelProblem> Judge(const std::vector<Labelling>& grown,
                                        std::size_t num_blobs) {
  if (grown.empty() || grown[0].num_labelled < 6 ||
      grown[0].num_labelled < kSmallestShare * grown[0].num_in_image) {
    return Unexpected{NotIdentifiable(fmt::format(
        "no camera sees the target's lines among the {} balls found: give seeds", num_blobs))};
  }
  if (grown.size() > 1 && grown[1].num_labelled >= kRivalShare * grown[0].num_labelled &&
      grown[1].camera.rms_px < kRivalRms * std::max(grown[0].camera.rms_px, kBlobSigma_px)) {
    return Unexpected{
        NotIdentifiable("the arrangement of the lines looks the same in several orientations: give"
                        " seeds")};
  }
  return grown[0];
}

}  // namespace

Expected<Labelling, LabelProblem> LabelFromRods(const Target& target,
                                                const std::vector<Eigen::Vector2d>& blobs_px,
                                                int width_px, int height_px) {
  std::vector<Eigen::Vector3d> points_mm;
  for (const TargetPoint& point : target.points) points_mm.push_back(point.xyz_mm);
  if (AreFlat(points_mm)) {
    return Unexpected{LabelProblem{LabelFailure::kFlat, {}, "the target's points lie in a plane"}};
  }
  const auto rods = FindTargetRods(points_mm, ToleranceOf(target));
  if (rods.size() < 2) {
    return Unexpected{NotIdentifiable(
        fmt::format("without seeds the points are told by lines of four or more; the target has {}"
                    " such lines, at least 2 are needed: give seeds",
                    rods.size()))};
  }
  RodLabeller labeller(points_mm, blobs_px, width_px, height_px);
  labeller.Place(rods);
  labeller.Propose();
  return Judge(labeller.Grow(), blobs_px.size());
}

}  // namespace stereomotion
