#include "learn_noise.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <string>
#include <utility>

#include "image_size.h"
#include "stereomotion/detection/estimate_noise.h"

namespace stereomotion {
namespace {

/// Pairs are looked through for readable ones up to this many times the number wanted.
constexpr int kSearchFactor = 4;
/// Pixels held at once for learning: large images need fewer pairs, having more background each.
constexpr std::int64_t kMostPixels = 64 << 20;

/// Reads the first readable pairs, a batch at a time in parallel.
std::vector<FramePair> ReadFirstPairs(const PairSource& source, const RigCamera& left,
                                      const RigCamera& right, std::int64_t first, std::int64_t end,
                                      int wanted) {
  std::vector<FramePair> pairs;
  const std::int64_t last =
      std::min(end, first + std::min(std::int64_t{kSearchFactor} * wanted, kPairsKept));
  for (std::int64_t position = first; position < last && static_cast<int>(pairs.size()) < wanted;) {
    const std::int64_t batch =
        std::min(last - position, std::int64_t{wanted} - static_cast<int>(pairs.size()));
    std::vector<std::future<std::optional<FramePair>>> reading;
    for (std::int64_t i = 0; i < batch; ++i) {
      reading.push_back(std::async(std::launch::async, [&source, at = position + i] {
        std::optional<FramePair> pair(std::in_place);
        if (!source.Read(at, *pair)) pair.reset();
        return pair;
      }));
    }
    for (auto& read : reading) {
      std::optional<FramePair> pair = read.get();
      if (!pair) continue;  // an endless source has ended; what follows comes to nothing at once
      if (HasSizeOf(left, pair->left) || HasSizeOf(right, pair->right))
        pairs.push_back(std::move(*pair));
    }
    position += batch;
  }
  return pairs;
}

NoiseRecord Settle(const RigCamera& camera, const std::vector<ImageView>& images,
                   const DetectionOptions& detection) {
  if (camera.noise) return {*camera.noise, "rig", 0};
  if (const auto learned = EstimateNoise(images, detection)) {
    return {*learned, "learned", static_cast<int>(images.size())};
  }
  NoiseRecord record;
  record.origin = "default";
  if (!images.empty() && images.front().type == PixelType::kGray16) {
    const int bits = images.front().grey_bits;
    record.noise.saturation_dn = bits > 0 ? std::ldexp(1.0, bits) - 1 : 65535;
  }
  return record;
}

void WarnOfDefault(const RigCamera& camera, const NoiseRecord& record, RunSummary& summary) {
  if (record.origin != "default") return;
  summary.warnings.push_back(
      "camera '" + camera.name +
      "': its noise could not be learned (too few ball pixels in the first frames); a default is "
      "used, so the covariances are only rough. Give `noise:` in the rig file, or start where "
      "balls "
      "are seen (--start)");
}

int PairsWanted(const RigCamera& left, int wanted) {
  const std::int64_t pixels_a_pair =
      std::max<std::int64_t>(1, 2LL * left.width_px * left.height_px);
  return static_cast<int>(
      std::clamp<std::int64_t>(kMostPixels / pixels_a_pair, 2, std::max(wanted, 2)));
}

}  // namespace

void LearnNoise(const PairSource& source, const MeasureSetup& setup, const MeasureOptions& options,
                std::int64_t end, RunSummary& summary) {
  const RigCamera& left = setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)];
  const RigCamera& right = setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)];
  std::vector<FramePair> pairs;
  if (!left.noise || !right.noise) {
    pairs = ReadFirstPairs(source, left, right, options.first, end,
                           PairsWanted(left, options.noise_pairs));
  }
  std::vector<ImageView> left_images;
  std::vector<ImageView> right_images;
  for (const FramePair& pair : pairs) {
    if (HasSizeOf(left, pair.left)) left_images.push_back(pair.left.image.View());
    if (HasSizeOf(right, pair.right)) right_images.push_back(pair.right.image.View());
  }
  auto settled_left =
      std::async(std::launch::async, [&] { return Settle(left, left_images, options.detection); });
  summary.noise_right = Settle(right, right_images, options.detection);
  summary.noise_left = settled_left.get();
  WarnOfDefault(left, summary.noise_left, summary);
  WarnOfDefault(right, summary.noise_right, summary);
}

}  // namespace stereomotion
