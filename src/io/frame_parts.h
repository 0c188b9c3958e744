#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stereomotion/io/frame_file.h"
#include "yaml_reader.h"

namespace stereomotion {

// The readers of frame.yaml's parts; each throws `UserError` and appends the files it read to
// `inputs`.
using InputFiles = std::vector<std::filesystem::path>;

Target ReadTarget(const YamlReader& node, InputFiles& inputs);
Target ReadWorldTarget(const YamlReader& node, InputFiles& inputs);

/// Reads the keys of a board's size and lays out its points.
void ReadBoard(const YamlReader& node, Target& board);

/// Reads `sigma_mm:`, how exactly a board was printed or a wand built; 0 where it is absent.
double ReadBuildSigma(const YamlReader& node, double smallest_feature_mm);

/// Reads `points:`, a list or the name of a CSV file.
std::vector<TargetPoint> ReadTargetPoints(const YamlReader& node, InputFiles& inputs);

/// Reads `ball_diameter_mm:`; `admit_flat` admits 0, which means flat marks.
double ReadBallDiameter(const YamlReader& node, bool admit_flat);

/// Refuses points in metres or micrometres, balls that overlap, points that come twice.
void CheckPoints(const YamlReader& node, const Target& target);

/// Finds a point by its id; -1: there is none.
int FindPoint(const Target& target, const std::string& id);
/// Phrases "; did you mean …" for an id that there is not.
std::string SuggestPoint(const Target& target, const std::string& id);

/// Tells how the points spread: 0 where all lie in one plane (line), relative to the longest axis
/// of their spread (singular values of the centred points).
double RelativeDepth(const std::vector<TargetPoint>& points);
double RelativeWidth(const std::vector<TargetPoint>& points);

/// Reads rough or exact image points from the CSV file that a key names.
std::vector<Seed> ReadSeeds(const YamlReader& node, const Target& target,
                            const CalibrationCamera& camera, std::size_t fewest,
                            InputFiles& inputs);
std::vector<MeasuredPoint> ReadObservations(const YamlReader& node, const Target& target,
                                            const CalibrationCamera& camera, InputFiles& inputs);

/// Reads what is known of a camera, and where its data are; `frame` holds the cameras so far, this
/// one included.
CalibrationCamera ReadCalibrationCamera(const YamlReader& node);
FrameCamera ReadFrameCamera(const YamlReader& node, const FrameFile& frame, InputFiles& inputs);

}  // namespace stereomotion
