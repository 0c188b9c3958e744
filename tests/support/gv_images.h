#pragma once

#include <vector>

#include "stereomotion/core/image.h"
#include "tests/support/gv_plan.h"

namespace stereomotion::testing {

/// Images of a synthetic camera; enough to tell a mix of neighbouring frames.
constexpr int kGvSyntheticImages = 64;

/// Byte of the synthetic pattern at (u, v) in image `place` of a camera of that name ("cam0", …).
std::uint8_t GvSyntheticByte(const std::string& camera, int place, int u, int v);

/// Loads the images of a camera, at most `plan.images`, in the order of their names; or makes the
/// synthetic ones. Throws `std::invalid_argument` where there are none or their sizes differ.
std::vector<Image> LoadGvImages(const GvPlan& plan);

}  // namespace stereomotion::testing
