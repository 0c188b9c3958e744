#include "detect_tags.h"

#include <algorithm>
#include <map>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "grey8.h"
#include "tag_family.h"

namespace stereomotion {
namespace {

/// One bit is corrected: with two, some families find tags in textures.
constexpr int kCorrectedBits = 1;
/// Mean contrast of the bits [DN]; beneath, single bits are near the noise.
constexpr float kMinMarginDn = 10;
/// A corner this share of a tag's side away from where the others have it belongs to no such board;
/// lens distortion is far less.
constexpr double kOffGrid = 0.4;

using Detector = std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)>;

/// The library counts a pixel's centre as 0.5 and corners from the bottom left, counter-clockwise.
Tag ToTag(const apriltag_detection_t& detection, int first_id) {
  Tag tag;
  tag.index = detection.id - first_id;
  for (int i = 0; i < Tag::kCorners; ++i) {
    const double* corner = detection.p[Tag::kCorners - 1 - i];
    tag.corners_px[i] = {corner[0] - 0.5, corner[1] - 0.5};
  }
  return tag;
}

std::vector<Tag> DetectAll(cv::Mat grey, const Target& target) {
  const TagFamily family = MakeTagFamily(target.family);
  const Detector detector(apriltag_detector_create(), apriltag_detector_destroy);
  detector->quad_decimate = 1;
  detector->nthreads = 1;
  apriltag_detector_add_family_bits(detector.get(), family.get(), kCorrectedBits);
  image_u8_t view = {grey.cols, grey.rows, static_cast<int>(grey.step), grey.data};
  zarray_t* found = apriltag_detector_detect(detector.get(), &view);
  std::vector<Tag> tags;
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found, i, &detection);
    if (detection->decision_margin < kMinMarginDn) continue;
    tags.push_back(ToTag(*detection, target.first_id));
  }
  apriltag_detections_destroy(found);
  apriltag_detector_remove_family(detector.get(), family.get());
  return tags;
}

/// Keeps ids that the board has and that appear once.
std::vector<Tag> KeepOwn(const std::vector<Tag>& tags, const Target& target) {
  std::map<int, int> counts;
  for (const Tag& tag : tags) ++counts[tag.index];
  std::vector<Tag> own;
  for (const Tag& tag : tags) {
    const bool on_board = tag.index >= 0 && tag.index < target.rows * target.cols;
    if (on_board && counts[tag.index] == 1) own.push_back(tag);
  }
  std::sort(own.begin(), own.end(), [](const Tag& a, const Tag& b) { return a.index < b.index; });
  return own;
}

/// Drops tags that do not lie on the board as the others show it: wrong ids, other prints.
std::vector<Tag> KeepOnGrid(const std::vector<Tag>& tags, const Target& target) {
  std::vector<cv::Point2d> board_mm, pixels_px, expected_px;
  double side_px = 0;
  for (const Tag& tag : tags) {
    side_px += tag.side_px() / static_cast<double>(tags.size());
    for (int i = 0; i < Tag::kCorners; ++i) {
      const Eigen::Vector3d& at = target.points[Tag::kCorners * tag.index + i].xyz_mm;
      board_mm.emplace_back(at.x(), at.y());
      pixels_px.emplace_back(tag.corners_px[i].x(), tag.corners_px[i].y());
    }
  }
  const cv::Mat homography =
      cv::findHomography(board_mm, pixels_px, cv::RANSAC, kOffGrid * side_px);
  if (homography.empty()) return {};
  cv::perspectiveTransform(board_mm, expected_px, homography);
  std::vector<Tag> kept;
  for (std::size_t t = 0; t < tags.size(); ++t) {
    double worst_px = 0;
    for (std::size_t i = Tag::kCorners * t; i < Tag::kCorners * (t + 1); ++i) {
      worst_px = std::max(worst_px, cv::norm(pixels_px[i] - expected_px[i]));
    }
    if (worst_px < kOffGrid * tags[t].side_px()) kept.push_back(tags[t]);
  }
  return kept;
}

/// Finds how the tags are turned on the board (all alike) and keeps those that lie on it.
///
/// Some programs print tags upside down: OpenCV's dictionaries are half turns of the AprilTag
/// library's. The places of two tags tell; a single one of several has to be left out.
std::vector<Tag> Arrange(const std::vector<Tag>& tags, const Target& target) {
  if (target.rows * target.cols == 1 || tags.empty()) return tags;
  if (tags.size() < 2) return {};
  std::vector<Tag> best;
  for (const int quarter_turns : {0, 2, 1, 3}) {
    std::vector<Tag> turned = tags;
    for (Tag& tag : turned) {
      std::rotate(tag.corners_px, tag.corners_px + quarter_turns, tag.corners_px + Tag::kCorners);
    }
    std::vector<Tag> kept = KeepOnGrid(turned, target);
    if (kept.size() > best.size()) best = std::move(kept);
    if (2 * best.size() > tags.size()) break;
  }
  return best.size() < 2 ? std::vector<Tag>() : best;
}

DetectedTags Detect(const cv::Mat& grey, const Target& target) {
  const std::vector<Tag> all = DetectAll(grey, target);
  return {Arrange(KeepOwn(all, target), target), static_cast<int>(all.size())};
}

}  // namespace

DetectedTags DetectBoardTags(const ImageView& image, const Target& target) {
  const cv::Mat grey = Grey8(image);
  DetectedTags tags = Detect(grey, target);
  const int num_on_board = static_cast<int>(tags.on_board.size());
  if (tags.num_detected > 0 && 2 * num_on_board < target.rows * target.cols) {
    // Kalibr's squares touch the tags; where white grows by a pixel they part.
    cv::Mat parted;
    cv::dilate(grey, parted, {});
    DetectedTags more = Detect(parted, target);
    if (more.on_board.size() > tags.on_board.size()) return more;
  }
  return tags;
}

}  // namespace stereomotion
