#pragma once

#include <string>
#include <vector>

#include "../frame_stream.h"
#include "h5_reader.h"

namespace stereomotion {

/// Holds what a recording file tells of one camera's frames besides their images.
struct H5Rows {
  std::vector<FrameInfo> frames;
  bool has_times = false, has_numbers = false, has_pairs = false;
};

/// Reads the columns of a group ("/cam0/") with `count` images; `fps` gives the times where there
/// are none. Throws `UserError`.
H5Rows ReadH5Rows(const H5Reader& reader, const std::string& group, std::int64_t count, double fps);

}  // namespace stereomotion
