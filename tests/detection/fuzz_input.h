#pragma once

#include <cstddef>
#include <cstdint>

namespace stereomotion::testing {

/// Runs a detector on an image, windows and a mask that the bytes describe: any size from 0 to some
/// hundred pixels or one extreme, any stride, 8 or 16 bits, any method. Aborts where a result makes
/// no sense.
void DetectFromBytes(const std::uint8_t* bytes, std::size_t size);

}  // namespace stereomotion::testing
