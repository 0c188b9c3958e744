#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/core/body.h"

namespace stereomotion {

/// Finds where a RUN keeps what was measured of one body: in RUN itself where there is one body, in
/// RUN/<name> where there are several.
std::filesystem::path FolderOfBody(const std::filesystem::path& run,
                                   const std::vector<Body>& bodies, std::size_t body);

/// Says why bodies cannot each have a folder of their name: no name, not one that every system
/// takes, or one that two have (capitals do not make it another). Empty: they can, or there is one.
std::string BodyNameProblem(const std::vector<Body>& bodies);

}  // namespace stereomotion
