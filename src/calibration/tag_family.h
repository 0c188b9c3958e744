#pragma once

#include <apriltag/apriltag.h>

#include <memory>
#include <string>

namespace stereomotion {

using TagFamily = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

/// Makes one of the families whose outer edge is black all around: tag36h11, tag36h10, tag25h9,
/// tag16h5. Throws std::invalid_argument for others (those of 2019 have data bits outside the
/// border, so that their outer black edge is no square).
TagFamily MakeTagFamily(const std::string& name);

}  // namespace stereomotion
