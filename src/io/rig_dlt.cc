#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "csv_table.h"
#include "export_formats.h"
#include "read_text.h"
#include "rig_formats.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

constexpr int kNumCoefficients = 11;
// A fit to image noise gives a skew of a few thousandths; beyond, these are no camera's numbers.
constexpr double kLargestSkew = 0.01;
using Matrix34d = Eigen::Matrix<double, 3, 4>;
using Coefficients = Eigen::Matrix<double, kNumCoefficients, Eigen::Dynamic>;

using Row = std::vector<double>;

// `place` is the file with the line's number.
Row ReadRow(const std::string& place, const std::string& line, std::size_t columns) {
  Row row;
  for (const std::string& cell : SplitCells(line)) {
    const auto value = ParseNumber(cell);
    if (!value) throw UserError(fmt::format("{}: found '{}', expected a number", place, cell));
    row.push_back(*value);
  }
  if (columns > 0 && row.size() != columns) {
    throw UserError(
        fmt::format("{}: found {} columns, expected {}, one a camera", place, row.size(), columns));
  }
  return row;
}

Coefficients ReadCoefficients(const std::filesystem::path& file) {
  std::vector<Row> rows;
  int number = 0;
  for (const std::string& line : SplitLines(ReadText(file, "a CSV file of DLT coefficients"))) {
    ++number;
    if (line.empty()) continue;
    rows.push_back(ReadRow(fmt::format("{}:{}", file.string(), number), line,
                           rows.empty() ? 0 : rows[0].size()));
  }
  if (rows.size() != kNumCoefficients) {
    throw UserError(
        fmt::format("{}: found {} rows, expected the 11 DLT coefficients, a column a "
                    "camera",
                    file.string(), rows.size()));
  }
  Coefficients coefficients(kNumCoefficients, rows[0].size());
  for (int i = 0; i < kNumCoefficients; ++i) {
    const Row& row = rows[static_cast<std::size_t>(i)];
    coefficients.row(i) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), coefficients.cols());
  }
  return coefficients;
}

Matrix34d ProjectionOf(const Coefficients& coefficients, Eigen::Index camera) {
  Eigen::Matrix<double, 12, 1> numbers;
  numbers << coefficients.col(camera), 1.0;
  return Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers.data());
}

// Scales a projection matrix so that points before the camera have their depth in the third row.
Matrix34d Normalized(const std::string& place, const Matrix34d& p) {
  const double det = p.leftCols<3>().determinant();
  const double length = p.row(2).head<3>().norm();
  if (!(std::abs(det) > 0) || !(length > 0)) {
    throw UserError(place + ": found coefficients of rank below 3, expected a camera's");
  }
  const Matrix34d normalized = p * ((det > 0 ? 1 : -1) / length);
  if (normalized(2, 3) < 0) {
    throw UserError(place +
                    ": the frame's origin lies behind the camera: v counts upwards in this file "
                    "(then give --dlt-pixels dltdv5), or its frame is left-handed");
  }
  return normalized;
}

// Splits a normalised projection matrix (world in mm, own pixels) into intrinsics, skew and pose:
// the rows of the rotation by Gram–Schmidt from the third upwards. Returns the skew.
double Decompose(const std::string& place, const Matrix34d& p, RigCamera& camera) {
  Eigen::Matrix3d rotation;
  CameraModel& model = camera.model;
  const Eigen::RowVector3d m1 = p.row(0).head<3>(), m2 = p.row(1).head<3>();
  rotation.row(2) = p.row(2).head<3>();
  model.cx_px = m1.dot(rotation.row(2));
  model.cy_px = m2.dot(rotation.row(2));
  const Eigen::RowVector3d second = m2 - model.cy_px * rotation.row(2);
  model.fy_px = second.norm();
  rotation.row(1) = second / model.fy_px;
  const double skew_px = m1.dot(rotation.row(1));
  const Eigen::RowVector3d first = m1 - model.cx_px * rotation.row(2) - skew_px * rotation.row(1);
  model.fx_px = first.norm();
  rotation.row(0) = first / model.fx_px;
  Eigen::Matrix3d k = CameraMatrix(model);
  k(0, 1) = skew_px;
  camera.cam_from_world = MakeRigid(place, rotation, k.inverse() * p.col(3));
  return skew_px;
}

// The skew tilts the image's columns: that much at the upper and lower edge.
void NoteSkew(const std::string& place, const RigCamera& camera, double skew_px,
              std::vector<std::string>& notes) {
  if (std::abs(skew_px) > kLargestSkew * camera.model.fx_px) {
    throw UserError(
        fmt::format("{}: found a skew of {:.3g} px at a focal length of {:.5g} px, "
                    "expected less than 1 %: no camera's coefficients",
                    place, skew_px, camera.model.fx_px));
  }
  const double shift_px = std::abs(skew_px) * camera.height_px / 2 / camera.model.fy_px;
  constexpr double kWorthTellingPx = 0.01;
  if (shift_px < kWorthTellingPx) return;
  notes.push_back(
      fmt::format("{}: the skew of {:.3g} px, which this camera model has not, is left "
                  "out: up to {:.2g} px at the image's edge",
                  place, skew_px, shift_px));
}

void RequireSizes(const std::filesystem::path& file, std::size_t num_sizes,
                  std::size_t num_cameras) {
  if (num_sizes != 1 && num_sizes != num_cameras) {
    throw UserError(
        fmt::format("{}: found {} image sizes for {} cameras, expected one, or one a "
                    "camera (--image-size 1280x1024)",
                    file.string(), num_sizes, num_cameras));
  }
}

}  // namespace

bool LooksLikeDlt(const std::filesystem::path& file) {
  for (const std::string& line : SplitLines(ReadText(file, "a rig file"))) {
    if (line.empty()) continue;
    const auto cells = SplitCells(line);
    return std::all_of(cells.begin(), cells.end(),
                       [](const std::string& cell) { return ParseNumber(cell).has_value(); });
  }
  return false;
}

ImportedRig ReadDltCsv(const std::filesystem::path& file,
                       const std::vector<Eigen::Vector2i>& sizes_px, const DltOptions& options) {
  const Coefficients coefficients = ReadCoefficients(file);
  const auto num_cameras = static_cast<std::size_t>(coefficients.cols());
  RequireSizes(file, sizes_px.size(), num_cameras);
  ImportedRig result;
  for (std::size_t i = 0; i < num_cameras; ++i) {
    const Eigen::Vector2i& size_px = sizes_px[sizes_px.size() == 1 ? 0 : i];
    RigCamera camera;
    camera.name = fmt::format("cam{}", i);
    camera.width_px = size_px.x();
    camera.height_px = size_px.y();
    Matrix34d p = DltFromPixel(options.pixels, camera.height_px).inverse() *
                  ProjectionOf(coefficients, static_cast<Eigen::Index>(i));
    p.leftCols<3>() /= options.mm_per_unit;
    const std::string place = fmt::format("{}: column {}", file.string(), i + 1);
    const double skew_px = Decompose(place, Normalized(place, p), camera);
    NoteSkew(place, camera, skew_px, result.notes);
    result.rig.cameras.push_back(camera);
  }
  CheckRig(file, result.rig);
  return result;
}

}  // namespace stereomotion
