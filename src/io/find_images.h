#pragma once

#include <filesystem>
#include <vector>

#include "yaml_reader.h"

namespace stereomotion {

/// Lists the images that a key of a YAML file names, in the natural order of their names (`img2`
/// before `img10`): a folder (all images in it), a file, or a pattern with * and ? in its last
/// component. Relative to the YAML file. Throws `UserError` where there are none.
std::vector<std::filesystem::path> FindImages(const YamlReader& node);

}  // namespace stereomotion
