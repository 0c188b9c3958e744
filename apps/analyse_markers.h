#pragma once

#include "analyse_inputs.h"
#include "analyse_options.h"

namespace stereomotion::app {

/// Reads a C3D or N3D file: the points of every --points are one rigid body. Throws `UserError`.
void LoadMarkers(const AnalyseArguments& arguments, AnalyseInputs& inputs);

}  // namespace stereomotion::app
