#include "pixel_order.h"

#include <algorithm>
#include <cmath>

namespace stereomotion {

void PixelOrder::Sort(const Eigen::Vector2f& direction, int size, Eigen::ArrayXf& u,
                      Eigen::ArrayXf& v, Eigen::ArrayXf& grey) {
  const auto place = [&](int i) { return direction[0] * u[i] + direction[1] * v[i]; };
  direction_ = direction;
  float last_px = first_px_ = place(0);
  for (int i = 1; i < size; ++i) {
    first_px_ = std::min(first_px_, place(i));
    last_px = std::max(last_px, place(i));
  }
  begins_.assign(static_cast<std::size_t>(last_px - first_px_) + 2, 0);
  steps_.resize(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i) {
    steps_[static_cast<std::size_t>(i)] = static_cast<int>(place(i) - first_px_);
    ++begins_[static_cast<std::size_t>(steps_[static_cast<std::size_t>(i)]) + 1];
  }
  for (std::size_t k = 1; k < begins_.size(); ++k) begins_[k] += begins_[k - 1];
  sorted_.resize(static_cast<std::size_t>(size));
  for (Eigen::ArrayXf* column : {&u, &v, &grey}) {
    next_ = begins_;
    for (int i = 0; i < size; ++i) {
      int& to = next_[static_cast<std::size_t>(steps_[static_cast<std::size_t>(i)])];
      sorted_[static_cast<std::size_t>(to++)] = (*column)[i];
    }
    std::copy(sorted_.begin(), sorted_.end(), column->data());
  }
}

PixelRange PixelOrder::Near(const Eigen::Vector2f& point, double reach_px, int size) const {
  if (begins_.empty()) return {0, size};
  const double middle_px = direction_.dot(point) - first_px_;
  const int steps = static_cast<int>(begins_.size()) - 1;
  const auto at = [&](double place_px) {
    if (!(place_px > 0)) return std::size_t{0};
    return static_cast<std::size_t>(std::min(place_px, static_cast<double>(steps)));
  };
  return {begins_[at(middle_px - reach_px)], begins_[at(middle_px + reach_px + 1)]};
}

}  // namespace stereomotion
