#include "learn_noise.h"

#include <algorithm>
#include <string>
#include <utility>

#include "image_size.h"
#include "stereomotion/detection/estimate_noise.h"

namespace stereomotion {
namespace {

NoiseRecord Settle(const RigCamera& camera, const std::vector<ImageView>& images,
                   const DetectionOptions& detection, std::vector<std::string>& warnings) {
  if (camera.noise) return {*camera.noise, "rig", 0};
  if (const auto learned = EstimateNoise(images, detection)) {
    return {*learned, "learned", static_cast<int>(images.size())};
  }
  NoiseRecord record;
  record.origin = "default";
  if (!images.empty() && images.front().type == PixelType::kGray16)
    record.noise.saturation_dn = 65535;
  warnings.push_back("camera '" + camera.name +
                     "': its noise could not be learned (too few ball pixels in the first frames); "
                     "a default is used, "
                     "so the covariances are only rough. Give `noise:` in the rig file, or start "
                     "where balls are seen (--start)");
  return record;
}

}  // namespace

void LearnNoise(const PairSource& source, const MeasureSetup& setup, const MeasureOptions& options,
                std::int64_t end, RunSummary& summary) {
  const RigCamera& left = setup.rig.cameras[static_cast<std::size_t>(setup.left_camera)];
  const RigCamera& right = setup.rig.cameras[static_cast<std::size_t>(setup.right_camera)];
  std::vector<FramePair> pairs;
  std::vector<ImageView> left_images;
  std::vector<ImageView> right_images;
  const std::int64_t last = std::min(end, options.first + 4 * std::int64_t{options.noise_pairs});
  for (std::int64_t i = options.first;
       i < last && static_cast<int>(pairs.size()) < options.noise_pairs; ++i) {
    FramePair pair;
    source.Read(i, pair);
    const bool left_ok = HasSizeOf(left, pair.left);
    const bool right_ok = HasSizeOf(right, pair.right);
    if (left_ok || right_ok) pairs.push_back(std::move(pair));
  }
  for (const FramePair& pair : pairs) {
    if (HasSizeOf(left, pair.left)) left_images.push_back(pair.left.image.View());
    if (HasSizeOf(right, pair.right)) right_images.push_back(pair.right.image.View());
  }
  summary.noise_left = Settle(left, left_images, options.detection, summary.warnings);
  summary.noise_right = Settle(right, right_images, options.detection, summary.warnings);
}

}  // namespace stereomotion
