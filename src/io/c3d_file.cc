#include "stereomotion/io/c3d_file.h"

#include <cmath>
#include <limits>

#include "binary_file.h"
#include "c3d_parameters.h"
#include "n3d_file.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

constexpr std::size_t kBlock = 512;  // bytes
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Where the words of the header stand, in bytes.
enum Header {
  kPoints = 2,
  kAnalog = 4,
  kFirstFrame = 6,
  kLastFrame = 8,
  kScale = 12,
  kDataBlock = 16,
  kRate = 20
};

double MillimetresPer(const std::string& unit, const BinaryFile& file) {
  if (unit.empty() || unit == "mm") return 1;
  if (unit == "cm") return 10;
  if (unit == "m") return 1000;
  if (unit == "in" || unit == "inches") return 25.4;
  if (unit == "um") return 1e-3;
  file.Fail("POINT:UNITS: found '" + unit + "', expected mm, cm, m, um or in");
}

// A count as a damaged file may tell it; 0 for what is none.
std::size_t Count(double number) {
  constexpr double kMost = 1e9;
  return number >= 0 && number <= kMost ? static_cast<std::size_t>(number) : 0;
}

// Two words tell the number of a frame in files with more than 65535 of them.
std::optional<double> LongNumber(const C3dParameters& parameters, const std::string& name) {
  const auto low = parameters.Number("TRIAL", name, 0), high = parameters.Number("TRIAL", name, 1);
  constexpr double kWords = 65536;
  if (!low || !high) return std::nullopt;
  return *low + kWords * *high;
}

// The newest way of telling goes first: the header's words end at 65535.
std::size_t CountFrames(const BinaryFile& file, const C3dParameters& parameters) {
  const auto start = LongNumber(parameters, "ACTUAL_START_FIELD");
  const auto end = LongNumber(parameters, "ACTUAL_END_FIELD");
  double count = file.Word(kLastFrame) - file.Word(kFirstFrame) + 1.0;
  if (start && end && *end >= *start && *start >= 1) {
    count = *end - *start + 1;
  } else if (const auto frames = parameters.Number("POINT", "LONG_FRAMES")) {
    count = *frames;
  } else if (const auto short_frames = parameters.Number("POINT", "FRAMES")) {
    count = *short_frames;
  }
  if (!(count >= 1) || count > static_cast<double>(file.size())) {
    file.Fail("found " + std::to_string(count) + " frames, expected 1 or more, as the file holds");
  }
  return static_cast<std::size_t>(count);
}

// How one frame's numbers lie in the file.
struct Layout {
  std::size_t points = 0, frames = 0, data_at = 0, frame_bytes = 0, number_bytes = 0;
  double scale = 1;  // of integers
};

Layout LayoutOf(const BinaryFile& file, const C3dParameters& parameters) {
  Layout layout;
  layout.points = Count(parameters.Number("POINT", "USED").value_or(file.Word(kPoints)));
  if (layout.points == 0) file.Fail("found no points, expected markers (analog data is not read)");
  layout.frames = CountFrames(file, parameters);
  const double scale = parameters.Number("POINT", "SCALE").value_or(file.Float(kScale));
  if (!std::isfinite(scale) || scale == 0) file.Fail("POINT:SCALE: found no number but 0");
  layout.number_bytes = scale < 0 ? 4 : 2;
  layout.scale = std::abs(scale);
  std::size_t block = file.Word(kDataBlock);
  if (block == 0) {
    block = Count(parameters.Number("POINT", "DATA_START").value_or(0));
  }
  if (block == 0) file.Fail("found data block 0, expected 2 or more");
  layout.data_at = (block - 1) * kBlock;
  layout.frame_bytes = layout.number_bytes * (4 * layout.points + file.Word(kAnalog));
  const std::size_t room = file.size() > layout.data_at ? file.size() - layout.data_at : 0;
  if (room / layout.frame_bytes < layout.frames) {
    file.Fail("ends after " + std::to_string(room / layout.frame_bytes) + " frames, expected " +
              std::to_string(layout.frames) + " (cut short or damaged)");
  }
  return layout;
}

// A negative residual marks a point that was not seen; so do, in files of some programs, exact
// zeros.
Eigen::Vector3d PointAt(const BinaryFile& file, const Layout& layout, std::size_t at,
                        double mm_per_unit) {
  Eigen::Vector3d point;
  double residual = 0;
  if (layout.number_bytes == 4) {
    for (std::size_t k = 0; k < 3; ++k) point[static_cast<int>(k)] = file.Float(at + 4 * k);
    residual = file.Float(at + 12);
  } else {
    for (std::size_t k = 0; k < 3; ++k) {
      point[static_cast<int>(k)] = layout.scale * file.SignedWord(at + 2 * k);
    }
    residual = file.SignedWord(at + 6);
  }
  const bool seen = residual >= 0 && point.allFinite() && !point.isZero(0);
  return seen ? Eigen::Vector3d(mm_per_unit * point) : Eigen::Vector3d::Constant(kNaN);
}

std::vector<std::string> Labels(const C3dParameters& parameters, std::size_t points) {
  std::vector<std::string> labels = parameters.Texts("POINT", "LABELS");
  for (int more = 2; labels.size() < points; ++more) {
    const auto next = parameters.Texts("POINT", "LABELS" + std::to_string(more));
    if (next.empty()) break;
    labels.insert(labels.end(), next.begin(), next.end());
  }
  for (std::size_t i = 0; i < points; ++i) {
    const std::string number = "point" + std::to_string(i + 1);
    if (i == labels.size()) labels.push_back(number);
    if (labels[i].empty()) labels[i] = number;
  }
  labels.resize(points);
  return labels;
}

C3dPoints ReadPoints(BinaryFile& file) {
  constexpr int kMagic = 0x50;
  if (file.Byte(1) != kMagic) file.Fail("found no C3D or N3D header, expected a file of markers");
  const C3dParameters parameters(file);
  const Layout layout = LayoutOf(file, parameters);
  C3dPoints points;
  points.labels = Labels(parameters, layout.points);
  points.rate_hz = parameters.Number("POINT", "RATE").value_or(file.Float(kRate));
  if (!(points.rate_hz > 0) || !std::isfinite(points.rate_hz)) {
    file.Fail("POINT:RATE: found no rate above 0, expected frames a second");
  }
  points.first_frame = static_cast<int>(
      Count(LongNumber(parameters, "ACTUAL_START_FIELD").value_or(file.Word(kFirstFrame))));
  const auto units = parameters.Texts("POINT", "UNITS");
  points.mm_per_unit = MillimetresPer(units.empty() ? "" : units.front(), file);
  points.points_mm.resize(layout.frames);
  for (std::size_t i = 0; i < layout.frames; ++i) {
    const std::size_t frame_at = layout.data_at + i * layout.frame_bytes;
    for (std::size_t k = 0; k < layout.points; ++k) {
      points.points_mm[i].push_back(
          PointAt(file, layout, frame_at + k * 4 * layout.number_bytes, points.mm_per_unit));
    }
  }
  return points;
}

C3dPoints ReadEither(BinaryFile file) {
  if (auto points = ReadN3d(file)) return *points;
  if (file.size() < kBlock) file.Fail("is too short for a C3D or N3D file");
  return ReadPoints(file);
}

}  // namespace

C3dPoints ReadC3d(const std::filesystem::path& file) {
  return ReadEither(BinaryFile(file, "a C3D or N3D file"));
}

C3dPoints ReadC3dBytes(std::string bytes, const std::string& name) {
  return ReadEither(BinaryFile::Of(std::move(bytes), name));
}

}  // namespace stereomotion
