#include <fmt/format.h>

#include <opencv2/core.hpp>

#include "export_formats.h"
#include "number_text.h"
#include "stereomotion/core/user_error.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr double kMetresPerMm = 1e-3;

template <class Matrix>
cv::Mat ToOpenCv(const Matrix& matrix) {
  cv::Mat copy(static_cast<int>(matrix.rows()), static_cast<int>(matrix.cols()), CV_64F);
  for (int i = 0; i < copy.rows; ++i) {
    for (int j = 0; j < copy.cols; ++j) copy.at<double>(i, j) = matrix(i, j);
  }
  return copy;
}

Eigen::Matrix<double, 1, 5> Coefficients(const CameraModel& model) {
  return {model.k1, model.k2, model.p1, model.p2, model.k3};
}

Rigid3 RelativePose(const Rig& rig, std::size_t camera) {
  return rig.cameras[camera].cam_from_world * rig.cameras[camera - 1].cam_from_world.Inverse();
}

// Kalibr's matrix from the camera before, in metres.
std::string StepText(const Rigid3& step) {
  const Eigen::Matrix3d rotation = step.rotation.toRotationMatrix();
  std::string text = "  T_cn_cnm1:\n";
  for (int row = 0; row < 3; ++row) {
    text += fmt::format("  - [{}, {}, {}, {}]\n", NumberText(rotation(row, 0)),
                        NumberText(rotation(row, 1)), NumberText(rotation(row, 2)),
                        NumberText(step.translation_mm[row] * kMetresPerMm));
  }
  return text + "  - [0.0, 0.0, 0.0, 1.0]\n";
}

// TOML's arrays hold numbers of one kind: every number is spelled as a floating-point one.
std::string FloatText(double number) {
  const std::string text = NumberText(number);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

template <class Vector>
std::string FloatList(const Vector& numbers) {
  std::string text;
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    text += (i > 0 ? ", " : "") + FloatText(numbers(i));
  }
  return "[ " + text + ",]";
}

std::string AniposeCamera(const RigCamera& camera, std::size_t number) {
  const Eigen::Matrix3d k = CameraMatrix(camera.model);
  const Eigen::Vector3d rotation_rad = LogSO3(camera.cam_from_world.rotation);
  return fmt::format(
      "[cam_{}]\nname = {}\nsize = [ {}, {},]\nmatrix = [ {}, {}, {},]\ndistortions = {}\n"
      "rotation = {}\ntranslation = {}\nfisheye = false\n\n",
      number, QuotedText(camera.name), camera.width_px, camera.height_px, FloatList(k.row(0)),
      FloatList(k.row(1)), FloatList(k.row(2)), FloatList(Coefficients(camera.model)),
      FloatList(rotation_rad), FloatList(camera.cam_from_world.translation_mm));
}

}  // namespace

// E = [t]× R and F = K2⁻ᵀ E K1⁻¹ as stereoCalibrate returns them.
std::string OpenCvText(const Rig& rig, bool xml) {
  const RigCamera& left = rig.cameras[0];
  const RigCamera& right = rig.cameras[1];
  if (left.width_px != right.width_px || left.height_px != right.height_px) {
    throw UserError("OpenCV's format holds one image size, found two different ones");
  }
  const Rigid3 right_from_left = RelativePose(rig, 1);
  const Eigen::Matrix3d rotation = right_from_left.rotation.toRotationMatrix();
  const Eigen::Matrix3d essential = Hat(right_from_left.translation_mm) * rotation;
  const Eigen::Matrix3d k1 = CameraMatrix(left.model), k2 = CameraMatrix(right.model);
  Eigen::Matrix3d fundamental = k2.inverse().transpose() * essential * k1.inverse();
  if (fundamental(2, 2) != 0) fundamental /= fundamental(2, 2);
  cv::FileStorage storage(xml ? ".xml" : ".yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  storage << "image_size" << cv::Size(left.width_px, left.height_px);
  storage << "K1" << ToOpenCv(k1) << "D1" << ToOpenCv(Coefficients(left.model));
  storage << "K2" << ToOpenCv(k2) << "D2" << ToOpenCv(Coefficients(right.model));
  storage << "R" << ToOpenCv(rotation) << "T" << ToOpenCv(right_from_left.translation_mm);
  storage << "E" << ToOpenCv(essential) << "F" << ToOpenCv(fundamental);
  return storage.releaseAndGetString();
}

std::string KalibrText(const Rig& rig) {
  std::string text;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    const CameraModel& m = camera.model;
    text += fmt::format("cam{}:\n", i);
    if (i > 0) text += StepText(RelativePose(rig, i));
    text += fmt::format(
        "  camera_model: pinhole\n  intrinsics: [{}, {}, {}, {}]\n  distortion_model: radtan\n"
        "  distortion_coeffs: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n",
        NumberText(m.fx_px), NumberText(m.fy_px), NumberText(m.cx_px), NumberText(m.cy_px),
        NumberText(m.k1), NumberText(m.k2), NumberText(m.p1), NumberText(m.p2), camera.width_px,
        camera.height_px);
  }
  return text;
}

std::string AniposeText(const Rig& rig) {
  std::string text;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) text += AniposeCamera(rig.cameras[i], i);
  return text + "[metadata]\nadjusted = false\nerror = 0.0\n";
}

}  // namespace stereomotion
