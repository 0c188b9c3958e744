#include "find_discs.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "normal_distribution.h"

namespace stereomotion {
namespace {

constexpr std::size_t kMostDiscs = 3;
/// A vote's error: the radius is known to some 8 %, a pixel's gradient direction to some 5°.
constexpr double kVoteError_radii = 0.12;
constexpr double kLeastVoteError_px = 0.8;
/// Less of a circle than this is no ball that is half visible.
constexpr double kSmallestArc = 0.2;
constexpr std::size_t kArcBins = 32;
/// An edge point's grey value lies within this share of the contrast from half height.
constexpr double kEdgeBand = 0.35;
/// Flatter slopes than this share of the contrast a pixel are shading, not limb.
constexpr double kFlattest_per_px = 0.12;
/// Bounds the time for large blobs: votes are compared in pairs.
constexpr std::size_t kMostVotes = 400;

}  // namespace

void DiscFinder::CastVotes(const ImageView& image, const Blob& blob, double radius_px) {
  votes_.clear();
  const double contrast = blob.peak_dn - blob.background_dn;
  const double half = blob.background_dn + 0.5 * contrast;
  constexpr int kMargin_px = 2;
  for (int v = std::max(blob.v_min - kMargin_px, 1);
       v <= std::min(blob.v_max + kMargin_px, image.height_px - 2); ++v) {
    for (int u = std::max(blob.u_min - kMargin_px, 1);
         u <= std::min(blob.u_max + kMargin_px, image.width_px - 2); ++u) {
      const double off = image.At(u, v) - half;
      if (std::abs(off) > kEdgeBand * contrast || votes_.size() >= kMostVotes) continue;
      // Sobel: less noise than central differences, and as exact on a blurred edge.
      const double left = image.At(u - 1, v - 1) + 2 * image.At(u - 1, v) + image.At(u - 1, v + 1);
      const double right = image.At(u + 1, v - 1) + 2 * image.At(u + 1, v) + image.At(u + 1, v + 1);
      const double up = image.At(u - 1, v - 1) + 2 * image.At(u, v - 1) + image.At(u + 1, v - 1);
      const double down = image.At(u - 1, v + 1) + 2 * image.At(u, v + 1) + image.At(u + 1, v + 1);
      const Eigen::Vector2d gradient((right - left) / 8, (down - up) / 8);
      const double slope = gradient.norm();
      if (slope < kFlattest_per_px * contrast) continue;
      const Eigen::Vector2d inwards = gradient / slope;
      votes_.push_back(
          {Eigen::Vector2d(u, v) + (radius_px - off / slope) * inwards, inwards, false});
    }
  }
}

int DiscFinder::CountNear(const Eigen::Vector2d& center_px, double reach_px) const {
  const double reach2 = reach_px * reach_px;
  return static_cast<int>(std::count_if(votes_.begin(), votes_.end(), [&](const Vote& vote) {
    return !vote.used && (vote.center_px - center_px).squaredNorm() < reach2;
  }));
}

bool DiscFinder::TakeBest(double reach_px) {
  int most = 0;
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  for (const Vote& vote : votes_) {
    if (vote.used) continue;
    const int count = CountNear(vote.center_px, reach_px);
    if (count > most) {
      most = count;
      best = vote.center_px;
    }
  }
  if (most == 0) return false;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::bitset<kArcBins> arc;
  for (Vote& vote : votes_) {
    if (vote.used || (vote.center_px - best).norm() > reach_px) continue;
    vote.used = true;
    sum += vote.center_px;
    const double turn = std::atan2(vote.direction.y(), vote.direction.x()) / (2 * kPi) + 0.5;
    arc.set(static_cast<std::size_t>(turn * kArcBins) % kArcBins);
  }
  const double share = static_cast<double>(arc.count()) / static_cast<double>(kArcBins);
  if (share < kSmallestArc) return false;
  places_.push_back({sum / most, share});
  return true;
}

const std::vector<DiscPlace>& DiscFinder::Find(const ImageView& image, const Blob& blob,
                                               double radius_px) {
  places_.clear();
  CastVotes(image, blob, radius_px);
  const double reach_px = std::max(kVoteError_radii * radius_px, kLeastVoteError_px);
  while (places_.size() < kMostDiscs && TakeBest(reach_px)) {
  }
  return places_;
}

}  // namespace stereomotion
