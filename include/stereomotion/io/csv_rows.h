#pragma once

#include <string>
#include <string_view>

#include "stereomotion/core/body.h"
#include "stereomotion/pose/pair_measurement.h"

namespace stereomotion {

/// Header lines of the files of a RUN, without the line's end (docs/formats.md).
std::string_view PosesHeader();
std::string_view BallsHeader();
std::string_view DetectionsHeader();

/// Append the rows of one frame pair, each with its line's end. Numbers carry ten significant
/// digits whatever the locale; what the data does not determine is an empty cell.
void AppendPoseRow(const PairMeasurement& measurement, std::string& rows);
void AppendBallRows(const PairMeasurement& measurement, const Body& body, std::string& rows);
void AppendDetectionRows(const PairMeasurement& measurement, const Body& body,
                         std::string_view left_camera, std::string_view right_camera,
                         std::string& rows);

}  // namespace stereomotion
