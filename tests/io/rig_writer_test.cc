#include "stereomotion/io/rig_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <stdexcept>

#include "io_test_support.h"
#include "rig_test_support.h"
#include "stereomotion/core/output_error.h"
#include "stereomotion/io/rig_export.h"
#include "stereomotion/io/rig_file.h"
#include "stereomotion/io/write_file.h"

namespace stereomotion {
namespace {

using testing::Has;
using testing::MakeTestRng;
using testing::TemporaryFolder;
using testing::TextFile;

// All thirty parameters, standard deviations from 1e-6 to 1: as a calibration gives them.
RigCovariance RandomCovariance(std::mt19937_64& rng, bool tied) {
  RigCovariance covariance;
  for (int i = 0; i < 2 * RigParameter::kPerCamera; ++i) {
    covariance.parameters.push_back({i / RigParameter::kPerCamera, i % RigParameter::kPerCamera});
  }
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  Eigen::MatrixXd root(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double sigma = std::pow(10.0, testing::Uniform(rng, -6, 0));
    for (Eigen::Index j = 0; j < n; ++j) root(i, j) = sigma * testing::Normal(rng);
  }
  if (tied) root.row(1) = root.row(0);  // fy = fx
  const Eigen::MatrixXd product = root * root.transpose();
  covariance.matrix = product.selfadjointView<Eigen::Upper>();  // symmetrical to the last digit
  return covariance;
}

std::string ReadAll(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(RigWriter, RoundTrip) {
  auto rng = MakeTestRng();
  for (const bool tied : {false, true}) {
    Rig rig = testing::RandomRig(rng);
    rig.cameras[0].source = R"(aravis:Basler "21"\876: #1)";
    rig.cameras[1].name = "null";
    rig.cameras[1].noise = SensorNoise{58.8, 8.1, 1.5, 4000};
    rig.covariance = RandomCovariance(rng, tied);
    CalibrationRecord record;
    record.date = "2024-05-01T12:00:00Z";
    record.rms_px = 0.0123;
    record.views = 24;
    const std::string text = RigYaml(rig, record);
    const Rig read = ReadRig(TextFile("rig.yaml", text).path());
    EXPECT_EQ(RigYaml(read, record), text);  // nothing is lost, not even a digit
    ASSERT_EQ(read.cameras.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const RigCamera &a = rig.cameras[i], &b = read.cameras[i];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.source, a.source);
      EXPECT_EQ(b.height_px, a.height_px);
      EXPECT_EQ(b.model.fx_px, a.model.fx_px);
      EXPECT_EQ(b.model.k3, a.model.k3);
      EXPECT_EQ(b.cam_from_world.translation_mm, a.cam_from_world.translation_mm);
      // Reading normalises: one rounding of each component.
      EXPECT_LT(b.cam_from_world.rotation.angularDistance(a.cam_from_world.rotation), 1e-12);
    }
    EXPECT_FALSE(read.cameras[0].noise);
    EXPECT_EQ(read.cameras[1].noise->black_dn, 1.5);
    EXPECT_TRUE(read.covariance->matrix == rig.covariance->matrix);
    EXPECT_EQ(read.covariance->parameters[17].index, 2);
    EXPECT_TRUE(Has(text, "calibration:\n  date: \"2024-05-01T12:00:00Z\"\n  views: 24\n"));
  }
}

// Spells numbers as in Germany: "1.234,5".
class GermanNumbers : public std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

TEST(RigWriter, LocaleDoesNotMatter) {
  auto rng = MakeTestRng();
  const Rig rig = testing::RandomRig(rng);
  const auto all = [&] {
    return RigYaml(rig) + ExportRig(rig, RigFormat::kOpenCvYaml).files[0].text +
           ExportRig(rig, RigFormat::kAnipose).files[0].text +
           ExportRig(rig, RigFormat::kRos).files[1].text;
  };
  const std::string text = all();
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  const std::string german = all();
  std::locale::global(before);
  EXPECT_EQ(german, text);
}

TEST(RigWriter, RefusesWhatNoFileCanHold) {
  auto rng = MakeTestRng();
  Rig rig = testing::RandomRig(rng);
  rig.cameras[1].model.k2 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RigYaml(rig), std::invalid_argument);
  rig = testing::RandomRig(rng);
  rig.cameras[0].width_px = 0;
  EXPECT_THROW(RigYaml(rig), std::invalid_argument);
  rig = testing::RandomRig(rng);
  rig.covariance = RigCovariance{{{0, 0}}, Eigen::MatrixXd::Identity(2, 2)};
  EXPECT_THROW(RigYaml(rig), std::invalid_argument);
}

TEST(WriteFile, ReplacesWhole) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "rig.yaml";
  WriteFileAtomically(file, "first, and longer");
  WriteFileAtomically(file, "second");
  EXPECT_EQ(ReadAll(file), "second");
  std::filesystem::create_symlink(file, folder.path() / "link");
  WriteFileAtomically(folder.path() / "link", "third");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link"));
  EXPECT_EQ(ReadAll(file), "third");
  WriteFileAtomically("/dev/null", "gone");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(WriteFile, FailureLeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  const auto file = folder.Write("rig.yaml", "old");
  EXPECT_THROW(WriteFileAtomically(folder.path(), "x"), OutputError);
  EXPECT_THROW(WriteFileAtomically(folder.path() / "none" / "rig.yaml", "x"), OutputError);
  // A limit on the size of files fails in the middle as a full disk does.
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{1000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  EXPECT_THROW(WriteFileAtomically(file, std::string(5000, 'x')), OutputError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(ReadAll(file), "old");
  const std::filesystem::directory_iterator files(folder.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

}  // namespace
}  // namespace stereomotion
