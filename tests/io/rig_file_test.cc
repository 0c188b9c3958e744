#include "stereomotion/io/rig_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io_test_support.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::TextFile;

struct RigText {
  std::string size = "[1280, 1024]", fx = "1800.1", cx = "640.2", qw = "1", tx = "-800";
  std::string end;

  [[nodiscard]] std::string text() const {
    return "format: stereomotion-rig/1\ncameras:\n" + Camera("cam0", "0") + Camera("cam1", tx) +
           end;
  }
  [[nodiscard]] std::string Camera(const std::string& name, const std::string& shift) const {
    return "  - name: " + name + "\n    image_size_px: " + size +
           "\n    intrinsics: {fx_px: " + fx + ", fy_px: 1800.3, cx_px: " + cx +
           ", cy_px: 511.7}\n" +
           "    distortion: [-0.1, 0.2, 0.001, 0.002, 0.3]\n    cam_from_world: {qw: " + qw +
           ", qx: 0, qy: 0, qz: 0, tx_mm: " + shift + ", ty_mm: 1, tz_mm: 2}\n";
  }
};

Rig ReadText(const std::string& text, const std::string& name = "rig.yaml") {
  const TextFile file(name, text);
  return ReadRig(file.path());
}

std::string ErrorOf(const std::string& text, const std::string& name = "rig.yaml") {
  return Error([&] { ReadText(text, name); });
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(RigFile, ReadsAllKeys) {
  RigText rig_text;
  rig_text.end =
      "noise: {gain_e_per_dn: 58.8, read_e: 8}\ncovariance:\n  parameters: [cam0.fx_px, "
      "cam1.tx_mm]\n"
      "  upper: [4, 1, 9]\ncalibration: {date: 2024-01-01, rms_px: 0.1}\n";
  const Rig rig = ReadText(rig_text.text());
  ASSERT_EQ(rig.cameras.size(), 2U);
  const RigCamera& camera = rig.cameras[1];
  EXPECT_EQ(camera.name, "cam1");
  EXPECT_EQ(camera.width_px, 1280);
  EXPECT_EQ(camera.height_px, 1024);
  EXPECT_EQ(camera.model.fx_px, 1800.1);
  EXPECT_EQ(camera.model.p2, 0.002);
  EXPECT_EQ(camera.model.k3, 0.3);
  EXPECT_EQ(camera.cam_from_world.translation_mm, Eigen::Vector3d(-800, 1, 2));
  EXPECT_EQ(camera.noise->gain_e_per_dn, 58.8);
  ASSERT_TRUE(rig.covariance);
  EXPECT_EQ(rig.covariance->parameters[1].camera, 1);
  EXPECT_EQ(rig.covariance->parameters[1].index, 12);
  EXPECT_EQ(rig.covariance->matrix(1, 0), 1);
}

TEST(RigFile, ExampleIsValid) {
  EXPECT_EQ(ReadRig(testing::SourceFile("calib/rig.yaml")).cameras.size(), 2U);
}

TEST(RigFile, NoisePerCamera) {
  RigText text;
  text.end = "noise:\n  cam1: {gain_e_per_dn: 10, read_e: 2}\n";
  const Rig rig = ReadText(text.text());
  EXPECT_FALSE(rig.cameras[0].noise);
  EXPECT_EQ(rig.cameras[1].noise->read_e, 2);
  text.end = "noise:\n  cam2: {gain_e_per_dn: 10, read_e: 2}\n";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "unknown key 'cam2'"));
}

TEST(RigFile, UnknownKeyWithSuggestion) {
  const std::string error = ErrorOf(Replaced(RigText().text(), "fx_px", "f_px"));
  EXPECT_TRUE(Has(error, "rig.yaml:5: cameras[0].intrinsics.f_px: unknown key 'f_px'")) << error;
  EXPECT_TRUE(Has(error, "did you mean 'fx_px'?")) << error;
}

TEST(RigFile, QuaternionNotUnit) {
  RigText text;
  text.qw = "1.01";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "a quaternion of norm 1.01"));
  text.qw = "1.0005";
  EXPECT_DOUBLE_EQ(ReadText(text.text()).cameras[0].cam_from_world.rotation.norm(), 1);
}

TEST(RigFile, MetresForMillimetres) {
  RigText text;
  text.tx = "-0.8";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "cam0 and cam1 stand 0.8 mm apart"));
  EXPECT_TRUE(Has(ErrorOf(text.text()), "in metres?"));
}

TEST(RigFile, ImageSizeAgainstIntrinsics) {
  RigText text;
  text.size = "[320, 240]";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "found the principal point (640.2, 511.7)"));
  text.size = "[1280.5, 1024]";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "a whole number"));
  text.size = "[1280, 1024]";
  text.fx = "8.0";
  EXPECT_TRUE(Has(ErrorOf(text.text()), "the focal length in pixels (not in mm)"));
}

TEST(RigFile, OneCamera) {
  const std::string text = "format: stereomotion-rig/1\ncameras:\n" + RigText().Camera("cam0", "0");
  EXPECT_TRUE(Has(ErrorOf(text), "found 1 camera(s), expected 2 or more"));
  EXPECT_TRUE(Has(ErrorOf(text + RigText().Camera("cam0", "100")), "'cam0' twice"));
}

TEST(RigFile, MovingCameraIsRefused) {
  const std::string text =
      Replaced(RigText().text(), "    distortion", "    moving: {pivot: free}\n    distortion");
  EXPECT_TRUE(Has(ErrorOf(text), "cannot follow a moving one"));
}

TEST(RigFile, CovarianceErrors) {
  RigText text;
  const auto error = [&](const std::string& parameters, const std::string& upper) {
    text.end = "covariance: {parameters: [" + parameters + "], upper: [" + upper + "]}\n";
    return ErrorOf(text.text());
  };
  EXPECT_TRUE(
      Has(error("cam0.fx_px, cam1.fx_px", "1, 0"), "found a list of 2, expected 3 numbers"));
  EXPECT_TRUE(Has(error("cam0.fx_px, cam1.fx_px", "1, 2, 1"), "positive semi-definite"));
  EXPECT_TRUE(Has(error("cam0.fx_px", "-1"), "negative variance"));
  EXPECT_TRUE(Has(error("cam0.fx_px, cam1.fx_px", "0, 1, 1"), "variance 0"));
  EXPECT_TRUE(Has(error("cam0.fx", "1"), "did you mean 'cam0.fx_px'?"));
  EXPECT_TRUE(Has(error("cam0.k1, cam0.k1", "1, 0, 1"), "'cam0.k1' twice"));
  EXPECT_EQ(error("cam0.fx_px, cam1.fx_px", "1, 1, 1"), "no error");  // singular is still one
}

constexpr const char* kOpenCv = R"(%YAML:1.0
---
image_size: [ 640, 480 ]
M1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 535., 0., 342., 0., 536., 235., 0., 0., 1. ]
D1: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.26, -0.04, 0.001, -0.002, 0.23 ]
M2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 537., 0., 327., 0., 537., 249., 0., 0., 1. ]
D2: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.28, 0.09, 0., 0., 0. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 0., -1., 0., 1., 0., 0., 0., 0., 1. ]
T: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ -83., 1., 2. ]
)";

TEST(RigFile, OpenCv) {
  const Rig rig = ReadText(kOpenCv, "stereo.yml");
  EXPECT_EQ(rig.cameras[0].width_px, 640);
  EXPECT_EQ(rig.cameras[0].model.p2, -0.002);
  EXPECT_EQ(rig.cameras[1].model.cy_px, 249);
  const Eigen::Vector3d p = rig.cameras[1].cam_from_world * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((p - Eigen::Vector3d(-83, 2, 2)).norm(), 1e-12);
}

TEST(RigFile, OpenCvErrors) {
  EXPECT_TRUE(
      Has(ErrorOf(Replaced(kOpenCv, "image_size", "images"), "s.yml"), "image size is missing"));
  EXPECT_TRUE(Has(ErrorOf(Replaced(kOpenCv, "\nR:", "\nRR:"), "s.yml"), "the key 'R' is missing"));
  EXPECT_TRUE(Has(ErrorOf(Replaced(kOpenCv, "0., -1., 0.,", "0., -1.1, 0.,"), "s.yml"),
                  "expected a rotation"));
  const auto eight = [](const char* last) {
    return Replaced(Replaced(kOpenCv, "cols: 5", "cols: 8"), "0.23 ]",
                    std::string("0.23, ") + last);
  };
  EXPECT_TRUE(Has(ErrorOf(eight("0., 0., 0.1 ]"), "s.yml"), "D1: found 8 coefficients"));
  EXPECT_EQ(ErrorOf(eight("0., 0., 0. ]"), "s.yml"), "no error");
}

constexpr const char* kKalibr = R"(cam0:
  camera_model: pinhole
  intrinsics: [535., 536., 342., 235.]
  distortion_model: radtan
  distortion_coeffs: [-0.26, -0.04, 0.001, -0.002]
  resolution: [640, 480]
  rostopic: /cam0
cam1:
  T_cn_cnm1:
  - [0., -1., 0., -0.083]
  - [1., 0., 0., 0.001]
  - [0., 0., 1., 0.002]
  - [0., 0., 0., 1.]
  camera_model: pinhole
  intrinsics: [537., 537., 327., 249.]
  distortion_model: radtan
  distortion_coeffs: [-0.28, 0.09, 0., 0.]
  resolution: [640, 480]
)";

TEST(RigFile, KalibrIsInMetres) {
  const Rig rig = ReadText(kKalibr, "camchain.yaml");
  EXPECT_EQ(rig.cameras[0].model.p2, -0.002);
  EXPECT_EQ(rig.cameras[0].model.k3, 0);
  const Eigen::Vector3d p = rig.cameras[1].cam_from_world * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((p - Eigen::Vector3d(-83, 2, 2)).norm(), 1e-12);
}

TEST(RigFile, KalibrErrors) {
  EXPECT_TRUE(Has(ErrorOf(Replaced(kKalibr, "radtan", "equidistant")), "'equidistant', expected"));
  EXPECT_TRUE(Has(ErrorOf(Replaced(kKalibr, "pinhole", "omni")), "'omni', expected 'pinhole'"));
  EXPECT_TRUE(Has(ErrorOf(Replaced(kKalibr, "T_cn_cnm1", "T_x")), "'T_cn_cnm1' is missing"));
}

constexpr const char* kAnipose = R"([cam_0]
name = "A"
size = [ 640, 480,]
matrix = [ [ 535.0, 0.0, 342.0,], [ 0.0, 536.0, 235.0,], [ 0.0, 0.0, 1.0,],]
distortions = [ -0.26, -0.04, 0.001, -0.002, 0.23,]
rotation = [ 0.0, 0.0, 0.0,]
translation = [ 0.0, 0.0, 0.0,]
fisheye = false

[cam_1]
name = "B"
size = [ 640, 480,]
matrix = [ [ 537.0, 0.0, 327.0,], [ 0.0, 537.0, 249.0,], [ 0.0, 0.0, 1.0,],]
distortions = [ -0.28, 0.0, 0.0, 0.0, 0.0,]
rotation = [ 0.0, 0.0, 1.5707963267948966,]
translation = [ -83.0, 1.0, 2.0,]

[metadata]
adjusted = false
error = 0.2
)";

TEST(RigFile, Anipose) {
  const Rig rig = ReadText(kAnipose, "calibration.toml");
  EXPECT_EQ(rig.cameras[0].name, "A");
  EXPECT_EQ(rig.cameras[0].model.k3, 0.23);
  const Eigen::Vector3d p = rig.cameras[1].cam_from_world * Eigen::Vector3d(1, 0, 0);
  EXPECT_LT((p - Eigen::Vector3d(-83, 2, 2)).norm(), 1e-12);
}

TEST(RigFile, AniposeErrors) {
  const auto error = [](const std::string& from, const std::string& to) {
    return ErrorOf(Replaced(kAnipose, from, to), "c.toml");
  };
  EXPECT_TRUE(Has(error("fisheye = false", "fisheye = true"), "expected a pinhole camera"));
  EXPECT_TRUE(Has(error("[ 640, 480,]", "[ 640,]"), "cam_0.size: expected a list of 2"));
  EXPECT_TRUE(Has(error("[ 640, 480,]", "[ 1e300, 480,]"), "cam_0.size: above 100000 px"));
  EXPECT_TRUE(Has(error("[ 640, 480,]", "[ 640, -1e300,]"), "cam_0.size: below 1 px"));
  EXPECT_TRUE(Has(error("[cam_0]", "[cam_0"), "c.toml:1: is not valid TOML"));
}

TEST(RigFile, FolderOrUnreadableFile) {
  EXPECT_TRUE(Has(Error([] { ReadRig("/tmp"); }), "/tmp: found a folder, expected a rig file"));
  EXPECT_TRUE(Has(Error([] { ReadRig("/proc/self/mem"); }), "/proc/self/mem: cannot be read"));
}

TEST(RigFile, MissingFile) {
  EXPECT_TRUE(
      Has(Error([] { ReadRig("/nowhere/rig.yaml"); }), "/nowhere/rig.yaml: cannot be read"));
}

}  // namespace
}  // namespace stereomotion
