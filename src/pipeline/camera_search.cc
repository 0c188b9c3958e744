#include "camera_search.h"

#include <stdexcept>

namespace stereomotion {

CameraSearch::CameraSearch(const SearchSettings& settings)
    : mask_width_px_(settings.mask.width_px()),
      mask_height_px_(settings.mask.height_px()),
      search_every_(settings.search_every),
      detector_(settings.noise, settings.detection, settings.mask) {
  if (settings.search_every < 1) {
    throw std::invalid_argument("CameraSearch: search_every must be 1 or more");
  }
}

bool CameraSearch::IsUsable(const Frame& frame) const {
  if (frame.image.empty()) return false;
  const ImageView image = frame.image.View();
  return mask_width_px_ == 0 ||
         (image.width_px == mask_width_px_ && image.height_px == mask_height_px_);
}

bool CameraSearch::DetectInWindows(const Frame& frame, std::vector<BallObservation>& balls) {
  const ImageView image = frame.image.View();
  const bool predicted = follower_.Predict(frame.timestamp_ns, image.width_px, image.height_px);
  if (!predicted || since_whole_ + 1 >= search_every_) return false;
  detector_.Detect(image, follower_.windows(), balls);
  return follower_.FindsAll(balls);
}

bool CameraSearch::Detect(const Frame& frame, std::vector<BallObservation>& balls) {
  balls.clear();
  if (!IsUsable(frame)) {
    follower_.Forget();
    return false;
  }
  if (search_every_ == 1) {
    detector_.Detect(frame.image.View(), balls);
    return true;
  }
  const bool in_windows = DetectInWindows(frame, balls);
  if (!in_windows) detector_.Detect(frame.image.View(), balls);
  follower_.Update(frame.timestamp_ns, balls);
  since_whole_ = in_windows ? since_whole_ + 1 : 0;
  return !in_windows;
}

}  // namespace stereomotion
