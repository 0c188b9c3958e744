#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "export_formats.h"
#include "number_text.h"
#include "rig_formats.h"
#include "stereomotion/core/user_error.h"

namespace stereomotion {
namespace {

constexpr double kMmPerMetre = 1000;
using Matrix34d = Eigen::Matrix<double, 3, 4>;
using RowMajor34d = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// One camera_info file.
struct CameraInfo {
  RigCamera camera;
  Eigen::Matrix3d rectified_from_cam;
  Matrix34d projection;  // of a rectified point, metres
  std::string place;
};

std::vector<double> ReadMatrix(const YamlReader& root, const char* key, std::size_t count) {
  return root.Required(key).Required("data").Numbers(count);
}

void ReadDistortion(const YamlReader& root, CameraModel& model) {
  const YamlReader name = root.Required("distortion_model");
  if (name.Text() != "plumb_bob") name.Fail("'" + name.Text() + "'", "'plumb_bob'");
  const YamlReader data = root.Required("distortion_coefficients").Required("data");
  std::vector<double> k = data.Numbers();
  if (k.size() != 4 && k.size() != 5) {
    data.Fail("a list of " + std::to_string(k.size()), "[k1, k2, p1, p2, k3]");
  }
  k.resize(5, 0.0);
  model.k1 = k[0], model.k2 = k[1], model.p1 = k[2], model.p2 = k[3], model.k3 = k[4];
}

// `camera_name` may be a path: narrow_stereo/left.
std::string ReadName(const YamlReader& root) {
  const auto name = root.Optional("camera_name");
  const std::string text = name ? name->Text() : "";
  return text.substr(text.find_last_of('/') + 1);
}

CameraInfo ReadInfo(const std::filesystem::path& file) {
  const YamlReader root = YamlReader::Load(file);
  if (!root.Has("camera_matrix")) {
    root.Fail("no camera_matrix", "a ROS camera_info file as camera_calibration writes it");
  }
  constexpr int kLargestSidePx = 65536;
  CameraInfo info;
  info.place = file.string();
  info.camera.width_px = root.Required("image_width").Integer(1, kLargestSidePx);
  info.camera.height_px = root.Required("image_height").Integer(1, kLargestSidePx);
  info.camera.name = ReadName(root);
  const auto k = ReadMatrix(root, "camera_matrix", 9);
  if (std::abs(k[1]) > 1e-9 || k[8] != 1) {
    root.Required("camera_matrix").Fail("a skewed matrix", "[fx 0 cx; 0 fy cy; 0 0 1]");
  }
  info.camera.model.fx_px = k[0], info.camera.model.cx_px = k[2];
  info.camera.model.fy_px = k[4], info.camera.model.cy_px = k[5];
  ReadDistortion(root, info.camera.model);
  info.rectified_from_cam = RowMajor3d(ReadMatrix(root, "rectification_matrix", 9).data());
  info.projection = RowMajor34d(ReadMatrix(root, "projection_matrix", 12).data());
  return info;
}

// Where the other camera stands in the rectified frame: its projection's last column.
Eigen::Vector3d ShiftMm(const CameraInfo& info) {
  const Matrix34d& p = info.projection;
  if (!(p(0, 0) > 0) || !(p(1, 1) > 0)) {
    throw UserError(info.place + ": projection_matrix: found a focal length of 0, expected one");
  }
  return Eigen::Vector3d(p(0, 3) / p(0, 0), p(1, 3) / p(1, 1), 0) * kMmPerMetre;
}

struct Rectification {
  Eigen::Matrix3d rectified_from_left, rectified_from_right;
  Eigen::Vector3d shift_mm;  // rectified right from rectified left
};

// Turns both cameras so that the line between them is an image axis, the one it is nearest to, and
// their common view is as near to both as can be (Fusiello, Trucco & Verri 2000).
Rectification Rectify(const Rigid3& right_from_left) {
  const Eigen::Matrix3d rotation = right_from_left.rotation.toRotationMatrix();
  const Eigen::Vector3d center = right_from_left.Inverse().translation_mm;
  const Eigen::Vector3d view =
      (Eigen::Vector3d::UnitZ() + rotation.transpose().col(2)).normalized();
  const int axis = std::abs(center.x()) >= std::abs(center.y()) ? 0 : 1;
  const Eigen::Vector3d along = center.normalized() * (center[axis] < 0 ? -1.0 : 1.0);
  constexpr double kSmallestSine = 0.1;  // nearer to the view, nothing remains of the image
  if (!(view.cross(along).norm() > kSmallestSine)) {
    throw UserError("ROS camera_info: one camera stands before the other; nothing to rectify");
  }
  const Eigen::Vector3d across = (axis == 0 ? view.cross(along) : along.cross(view)).normalized();
  Rectification r;
  r.rectified_from_left.row(axis) = along;
  r.rectified_from_left.row(1 - axis) = across;
  r.rectified_from_left.row(2) = r.rectified_from_left.row(0).cross(r.rectified_from_left.row(1));
  r.rectified_from_right = r.rectified_from_left * rotation.transpose();
  r.shift_mm = -(r.rectified_from_left * center);
  return r;
}

template <class Matrix>
std::string MatrixText(const char* key, const Matrix& matrix) {
  std::string data;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      data += (data.empty() ? "" : ", ") + NumberText(matrix(i, j));
    }
  }
  return fmt::format("{}:\n  rows: {}\n  cols: {}\n  data: [{}]\n", key, matrix.rows(),
                     matrix.cols(), data);
}

std::string InfoText(const RigCamera& camera, const Eigen::Matrix3d& rectified_from_cam,
                     const Matrix34d& projection) {
  const CameraModel& m = camera.model;
  const Eigen::Matrix<double, 1, 5> k(m.k1, m.k2, m.p1, m.p2, m.k3);
  return fmt::format("image_width: {}\nimage_height: {}\ncamera_name: {}\n", camera.width_px,
                     camera.height_px, QuotedText(camera.name)) +
         MatrixText("camera_matrix", CameraMatrix(m)) + "distortion_model: plumb_bob\n" +
         MatrixText("distortion_coefficients", k) +
         MatrixText("rectification_matrix", rectified_from_cam) +
         MatrixText("projection_matrix", projection);
}

}  // namespace

Rig ReadRosCameraInfo(const std::filesystem::path& left, const std::filesystem::path& right) {
  CameraInfo first = ReadInfo(left), second = ReadInfo(right);
  const Eigen::Vector3d shift_mm = ShiftMm(second) - ShiftMm(first);
  if (shift_mm.isZero(0)) {
    throw UserError(right.string() +
                    ": projection_matrix: found no shift in its last column, expected that of a "
                    "stereo calibration (fx · baseline, metres)");
  }
  const Rigid3 rectified_from_left =
      MakeRigid(left.string() + ": rectification_matrix", first.rectified_from_cam, {0, 0, 0});
  const Rigid3 rectified_from_right =
      MakeRigid(right.string() + ": rectification_matrix", second.rectified_from_cam, {0, 0, 0});
  const Rigid3 shift{Eigen::Quaterniond::Identity(), shift_mm};
  second.camera.cam_from_world = rectified_from_right.Inverse() * shift * rectified_from_left;
  const bool named = !first.camera.name.empty() && !second.camera.name.empty();
  if (!named || first.camera.name == second.camera.name) {
    first.camera.name = "left";
    second.camera.name = "right";
  }
  Rig rig;
  rig.cameras = {first.camera, second.camera};
  CheckRig(right, rig);
  return rig;
}

// The rectified images share the mean focal length and principal point of both cameras.
std::array<std::string, 2> RosTexts(const Rig& rig) {
  const RigCamera& left = rig.cameras[0];
  const RigCamera& right = rig.cameras[1];
  const Rectification r = Rectify(right.cam_from_world * left.cam_from_world.Inverse());
  const Eigen::Matrix3d mean = (CameraMatrix(left.model) + CameraMatrix(right.model)) / 2;
  const double f_px = (mean(0, 0) + mean(1, 1)) / 2;
  Matrix34d projection;
  projection << f_px, 0, mean(0, 2), 0, 0, f_px, mean(1, 2), 0, 0, 0, 1, 0;
  const std::string left_text = InfoText(left, r.rectified_from_left, projection);
  // Exactly along one axis; the other component is rounding.
  const int axis = std::abs(r.shift_mm.x()) >= std::abs(r.shift_mm.y()) ? 0 : 1;
  projection(axis, 3) = f_px * r.shift_mm[axis] / kMmPerMetre;
  return {left_text, InfoText(right, r.rectified_from_right, projection)};
}

}  // namespace stereomotion
