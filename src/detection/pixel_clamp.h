#pragma once

#include <algorithm>
#include <limits>

namespace stereomotion {

/// Gives the pixel value nearest below `value`, within the type's range.
template <class T, class Number>
T ClampToPixel(Number value) {
  constexpr auto kHighest = static_cast<Number>(std::numeric_limits<T>::max());
  return static_cast<T>(std::clamp(value, Number{0}, kHighest));
}

}  // namespace stereomotion
