#include "stereomotion/io/rig_export.h"

#include <gtest/gtest.h>

#include "io_test_support.h"
#include "rig_test_support.h"
#include "stereomotion/io/rig_file.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::kRoundingPx;
using testing::LargestImageDistancePx;
using testing::MakeTestRng;
using testing::TemporaryFolder;
using testing::TextFile;

Rig ThroughFile(const Rig& rig, RigFormat format, const std::string& name) {
  return ReadRig(TextFile(name, ExportRig(rig, format).files.at(0).text).path());
}

TEST(RigExport, OpenCvRoundTrip) {
  auto rng = MakeTestRng();
  const Rig rig = testing::RandomRig(rng);
  const Rigid3& cam_from_world = rig.cameras[0].cam_from_world;  // becomes the world
  for (const auto& [format, name] :
       {std::pair{RigFormat::kOpenCvYaml, "s.yml"}, {RigFormat::kOpenCvXml, "s.xml"}}) {
    const Rig read = ThroughFile(rig, format, name);
    EXPECT_EQ(read.cameras[1].model.k3, rig.cameras[1].model.k3);
    EXPECT_LT(LargestImageDistancePx(rig, read, cam_from_world, rng), kRoundingPx);
  }
}

TEST(RigExport, KalibrRoundTripOfThreeCameras) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng);
  rig.cameras.push_back(testing::RandomRig(rng).cameras[1]);
  for (RigCamera& camera : rig.cameras) camera.model.k3 = 0;
  rig.cameras[2].cam_from_world.translation_mm.y() += 400;
  const Rig read = ThroughFile(rig, RigFormat::kKalibr, "camchain.yaml");
  ASSERT_EQ(read.cameras.size(), 3U);
  EXPECT_LT(LargestImageDistancePx(rig, read, rig.cameras[0].cam_from_world, rng), kRoundingPx);
}

TEST(RigExport, AniposeRoundTripKeepsTheWorld) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng);
  rig.cameras[0].name = "left \"eye\"";
  rig.cameras[1].model.k3 = 1;  // spelled 1.0: TOML's lists hold one kind of number
  const Rig read = ThroughFile(rig, RigFormat::kAnipose, "calibration.toml");
  EXPECT_EQ(read.cameras[0].name, rig.cameras[0].name);
  EXPECT_LT(LargestImageDistancePx(rig, read, {}, rng), kRoundingPx);
}

TEST(RigExport, RosRoundTripHorizontalAndVertical) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng);
  for (int i = 0; i < 2; ++i) {
    const RigExport made = ExportRig(rig, RigFormat::kRos);
    const TemporaryFolder folder;
    const auto left = folder.Write(made.files.at(0).name, made.files[0].text);
    const auto right = folder.Write(made.files.at(1).name, made.files[1].text);
    const Rig read = ReadRosCameraInfo(left, right);
    EXPECT_EQ(read.cameras[1].name, "cam1");
    EXPECT_LT(LargestImageDistancePx(rig, read, rig.cameras[0].cam_from_world, rng), kRoundingPx);
    rig.cameras[1].cam_from_world = rig.cameras[0].cam_from_world;  // next: one above the other
    rig.cameras[1].cam_from_world.translation_mm += Eigen::Vector3d(10, -400, 20);
  }
  rig.cameras[1].cam_from_world = rig.cameras[0].cam_from_world;
  rig.cameras[1].cam_from_world.translation_mm.z() += 300;
  EXPECT_TRUE(Has(Error([&] { ExportRig(rig, RigFormat::kRos); }), "before the other"));
}

TEST(RigExport, DltRoundTrip) {
  auto rng = MakeTestRng();
  const Rig rig = testing::RandomRig(rng, false);
  for (const DltPixels pixels : {DltPixels::kZeroBased, DltPixels::kDltdv8, DltPixels::kDltdv5}) {
    const TextFile file("dlt.csv", ExportRig(rig, RigFormat::kDlt, {false, pixels}).files[0].text);
    const ImportedRig read = ReadDltCsv(file.path(), {{1280, 1024}}, {pixels, 1});
    EXPECT_TRUE(read.notes.empty());
    // Eleven coefficients of very different size: some digits more are lost on the way.
    EXPECT_LT(LargestImageDistancePx(rig, read.rig, {}, rng), 100 * kRoundingPx);
  }
}

TEST(RigExport, DltDistortionIsRefusedOrTold) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng, false);
  rig.cameras[1].model = {1000, 1000, 640, 512, 0.1};
  const std::string error = Error([&] { ExportRig(rig, RigFormat::kDlt); });
  // At the corner r² = 0.64² + 0.512²; the shift is f k1 r³ = 55 px.
  EXPECT_TRUE(Has(error, "the distortion of camera cam1, which 55 px")) << error;
  EXPECT_TRUE(Has(error, "--drop-distortion")) << error;
  const RigExport made = ExportRig(rig, RigFormat::kDlt, {true, DltPixels::kZeroBased});
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_TRUE(Has(made.notes[0], "is left out"));
}

TEST(RigExport, KalibrHoldsNoK3) {
  auto rng = MakeTestRng();
  const Rig rig = testing::RandomRig(rng);
  EXPECT_TRUE(Has(Error([&] { ExportRig(rig, RigFormat::kKalibr); }), "k3 of camera cam0"));
  const RigExport made = ExportRig(rig, RigFormat::kKalibr, {true, DltPixels::kZeroBased});
  const Rig read = ReadRig(TextFile("c.yaml", made.files[0].text).path());
  EXPECT_EQ(read.cameras[1].model.p2, rig.cameras[1].model.p2);
  EXPECT_EQ(read.cameras[1].model.k3, 0);
  EXPECT_EQ(made.notes.size(), 3U);  // both k3, and the world
}

TEST(RigExport, WhatAFormatCannotHold) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng, false);
  rig.covariance = RigCovariance{{{0, 0}}, Eigen::MatrixXd::Identity(1, 1)};
  EXPECT_TRUE(Has(ExportRig(rig, RigFormat::kAnipose).notes.at(0), "no covariance"));
  EXPECT_TRUE(Has(ExportRig(rig, RigFormat::kRos).notes.at(1), "becomes the frame of cam0"));
  rig.cameras[1].width_px = 640;
  EXPECT_TRUE(Has(Error([&] { ExportRig(rig, RigFormat::kOpenCvXml); }), "one image size"));
  rig.cameras[1].cam_from_world.translation_mm.z() = 0;
  EXPECT_TRUE(Has(Error([&] { ExportRig(rig, RigFormat::kDlt); }), "the plane of camera cam1"));
  rig.cameras.push_back(rig.cameras[0]);
  EXPECT_TRUE(Has(Error([&] { ExportRig(rig, RigFormat::kRos); }), "two cameras, found 3"));
}

}  // namespace
}  // namespace stereomotion
