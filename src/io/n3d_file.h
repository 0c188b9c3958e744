#pragma once

#include <optional>

#include "binary_file.h"
#include "stereomotion/io/c3d_file.h"

namespace stereomotion {

/// Reads an N3D file, NDI's floating point format of its Optotrak; nothing where the file is none.
/// Throws `UserError` for one that is cut short.
std::optional<C3dPoints> ReadN3d(const BinaryFile& file);

}  // namespace stereomotion
