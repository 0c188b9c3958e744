#include "n3d_file.h"

#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

// A header of 256 bytes, then x, y, z of every marker, frame by frame, in mm; what was not seen is
// −3.7e28.
struct NdiHeader {
  static constexpr std::size_t kSize = 256;
  std::size_t items = 0, subitems = 0, frames = 0;
};

std::optional<NdiHeader> NdiHeaderOf(const BinaryFile& file) {
  constexpr int kFileType = 32;
  if (file.size() < NdiHeader::kSize || file.Byte(0) != kFileType) return std::nullopt;
  NdiHeader header;
  header.items = file.Word(1);
  header.subitems = file.Word(3);
  header.frames = file.Word(5) + (static_cast<std::size_t>(file.Word(7)) << 16U);
  constexpr std::size_t kCoordinates = 3, kC3dMagic = 0x50;
  const bool fits = header.subitems == kCoordinates && header.items > 0 &&
                    header.items * header.frames <= file.size() &&
                    file.size() == NdiHeader::kSize + 12 * header.items * header.frames;
  if (fits) return header;
  if (file.Byte(1) == kC3dMagic) return std::nullopt;
  file.Fail("found an NDI header of " + std::to_string(header.items) + " markers with " +
            std::to_string(header.subitems) + " numbers in " + std::to_string(header.frames) +
            " frames, expected 3 numbers and as many bytes as that makes (cut short or damaged)");
}

C3dPoints ReadPoints(const BinaryFile& file, const NdiHeader& header) {
  constexpr std::size_t kRateAt = 9;
  constexpr double kMissing = -1e20;
  C3dPoints points;
  points.rate_hz = file.Float(kRateAt);
  if (!(points.rate_hz > 0) || !std::isfinite(points.rate_hz)) {
    file.Fail("found no rate above 0 in the header, expected frames a second");
  }
  for (std::size_t k = 0; k < header.items; ++k) {
    points.labels.push_back("point" + std::to_string(k + 1));
  }
  std::size_t at = NdiHeader::kSize;
  points.points_mm.resize(header.frames);
  for (auto& frame : points.points_mm) {
    for (std::size_t k = 0; k < header.items; ++k, at += 12) {
      const Eigen::Vector3d point(file.Float(at), file.Float(at + 4), file.Float(at + 8));
      const bool seen = point.allFinite() && point.minCoeff() > kMissing;
      frame.push_back(seen ? point
                           : Eigen::Vector3d(Eigen::Vector3d::Constant(
                                 std::numeric_limits<double>::quiet_NaN())));
    }
  }
  return points;
}

}  // namespace

std::optional<C3dPoints> ReadN3d(const BinaryFile& file) {
  const auto header = NdiHeaderOf(file);
  if (!header) return std::nullopt;
  return ReadPoints(file, *header);
}

}  // namespace stereomotion
