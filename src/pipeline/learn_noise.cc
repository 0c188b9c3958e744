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

/// Pixels held at once for learning: large images need fewer pairs, having more background each.
constexpr std::int64_t kMostPixels = 64 << 20;

/// The first images of one camera.
struct FirstImages {
  explicit FirstImages(const RigCamera& of) : camera(of) {}
  /// Takes it where it is wanted. A camera often begins some images after the other one.
  void Take(Frame& frame, int wanted) {
    if (MissingOf(wanted) > 0 && HasSizeOf(camera, frame)) images.push_back(std::move(frame.image));
  }
  [[nodiscard]] int MissingOf(int wanted) const {
    return camera.noise ? 0 : wanted - static_cast<int>(images.size());
  }
  const RigCamera& camera;
  std::vector<Image> images;
};

/// Holds what is learned from: the same of a recording as of the cameras while it was recorded.
struct FirstLook {
  FirstImages left, right;
  bool has_pair = false;   ///< images of both cameras
  bool has_ended = false;  ///< an endless source did, meanwhile
};

std::vector<std::optional<FramePair>> ReadTogether(const PairSource& source, std::int64_t first,
                                                   std::int64_t count) {
  std::vector<std::future<std::optional<FramePair>>> reading;
  for (std::int64_t i = 0; i < count; ++i) {
    reading.push_back(std::async(std::launch::async, [&source, at = first + i] {
      std::optional<FramePair> pair(std::in_place);
      if (!source.Read(at, *pair)) pair.reset();
      return pair;
    }));
  }
  std::vector<std::optional<FramePair>> pairs;
  for (auto& read : reading) pairs.push_back(read.get());
  return pairs;
}

/// Reads until there are so many images of each camera, through `kPairsKept` pairs at most.
void ReadFirstImages(const PairSource& source, std::int64_t first, std::int64_t end, int wanted,
                     FirstLook& look) {
  const std::int64_t last = end - first > kPairsKept ? first + kPairsKept : end;
  for (std::int64_t position = first; position < last && !look.has_ended;) {
    const int missing = std::max(look.left.MissingOf(wanted), look.right.MissingOf(wanted));
    if (missing <= 0) return;
    const std::int64_t batch = std::min<std::int64_t>(last - position, missing);
    for (std::optional<FramePair>& pair : ReadTogether(source, position, batch)) {
      look.has_ended = look.has_ended || !pair;
      if (!pair) continue;
      look.has_pair = look.has_pair || (!pair->left.image.empty() && !pair->right.image.empty());
      look.left.Take(pair->left, wanted);
      look.right.Take(pair->right, wanted);
    }
    position += batch;
  }
}

NoiseRecord Settle(const FirstImages& first, const DetectionOptions& detection) {
  if (first.camera.noise) return {*first.camera.noise, "rig", 0};
  std::vector<ImageView> images;
  for (const Image& image : first.images) images.push_back(image.View());
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

void WarnOfDefault(const RigCamera& camera, const NoiseRecord& record, bool is_endless,
                   RunSummary& summary) {
  if (record.origin != "default") return;
  summary.warnings.push_back(
      "camera '" + camera.name +
      "': its noise could not be learned (too few ball pixels in the first frames); a default is "
      "used, so the covariances are only rough. Give `noise:` in the rig file, or start where "
      "balls are seen" +
      (is_endless ? "" : " (--start)"));
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
  FirstLook look{FirstImages(left), FirstImages(right)};
  ReadFirstImages(source, options.first, end, PairsWanted(left, options.noise_pairs), look);
  auto settled_left =
      std::async(std::launch::async, [&] { return Settle(look.left, options.detection); });
  summary.noise_right = Settle(look.right, options.detection);
  summary.noise_left = settled_left.get();
  if (look.has_ended && !look.has_pair) return;  // stopped before anything could be measured
  const bool is_endless = source.size() == kEndlessSource;
  WarnOfDefault(left, summary.noise_left, is_endless, summary);
  WarnOfDefault(right, summary.noise_right, is_endless, summary);
}

}  // namespace stereomotion
