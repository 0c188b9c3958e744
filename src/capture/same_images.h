#pragma once

#include <string>

#include "stereomotion/core/image.h"

namespace stereomotion {

/// Requires that an image of a recording is of the size and type of those before: a recording holds
/// one kind. `where`: the recording. Throws `OutputError`.
void RequireSameImages(const std::string& where, const std::string& camera, const ImageView& before,
                       const ImageView& now);

}  // namespace stereomotion
