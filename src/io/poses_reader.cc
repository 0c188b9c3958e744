#include <Eigen/Eigenvalues>
#include <cmath>

#include "csv_stream.h"
#include "stereomotion/geometry/so3.h"
#include "stereomotion/io/motion_reader.h"

namespace stereomotion {
namespace {

constexpr double kNsPerS = 1e9;

std::vector<std::string> CovarianceColumns() {
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) names.push_back("cov_" + std::to_string(i) + std::to_string(j));
  }
  return names;
}

// Reads a CSV file of poses, row by row.
class PosesFile {
 public:
  explicit PosesFile(const std::filesystem::path& file) : csv_(file, "a CSV file of poses") {
    frame_ = csv_.Find("frame");
    status_ = csv_.Find("status");
    time_ns_ = csv_.Find("timestamp_ns");
    time_s_ = csv_.Find("time_s");
    if (time_s_ < 0) static_cast<void>(csv_.Require("timestamp_ns"));
    for (const char* name : {"qw", "qx", "qy", "qz", "tx_mm", "ty_mm", "tz_mm"}) {
      pose_.push_back(csv_.Require(name));
    }
    covariance_ = csv_.FindAll(CovarianceColumns());
    calibration_ = csv_.FindAll(
        {"ucal_rx_rad", "ucal_ry_rad", "ucal_rz_rad", "ucal_tx_mm", "ucal_ty_mm", "ucal_tz_mm"});
    free_ = csv_.FindAll({"free_x", "free_y", "free_z"});
  }

  PoseSeries ReadAll() {
    PoseSeries series;
    while (csv_.Next()) {
      const PoseSample sample = Sample(static_cast<std::int64_t>(series.size()));
      if (!series.empty() && sample.timestamp_ns <= series.back().timestamp_ns) {
        csv_.Fail(time_ns_ >= 0 ? time_ns_ : time_s_, "a time after the row before");
      }
      series.push_back(sample);
    }
    if (series.empty()) csv_.Fail("found no row below the header, expected a row a frame");
    return series;
  }

 private:
  [[nodiscard]] PoseSample Sample(std::int64_t row) const {
    PoseSample sample;
    sample.frame = frame_ >= 0 ? csv_.Integer(frame_) : row;
    sample.timestamp_ns = Time();
    sample.measured = !csv_.AllEmpty(pose_) && IsMeasured();
    if (!sample.measured) return sample;
    sample.world_from_body = Pose();
    if (!free_.empty() && !csv_.AllEmpty(free_)) sample.free_axis_in_world = FreeAxis();
    if (!covariance_.empty()) sample.covariance = Covariance(sample.free_axis_in_world.has_value());
    if (!calibration_.empty() && !csv_.AllEmpty(calibration_)) {
      Vector6d u;
      for (int i = 0; i < 6; ++i) u[i] = csv_.Number(calibration_[static_cast<std::size_t>(i)]);
      sample.calibration_u = u;
    }
    return sample;
  }

  [[nodiscard]] bool IsMeasured() const {
    return status_ < 0 || csv_.Cell(status_) == "ok" || csv_.Cell(status_) == "filled";
  }

  [[nodiscard]] std::int64_t Time() const {
    if (time_ns_ >= 0) return csv_.Integer(time_ns_);
    const double time_ns = kNsPerS * csv_.Number(time_s_);
    constexpr double kLongest_ns = 9e18;  // what an int64 holds
    if (std::abs(time_ns) > kLongest_ns) csv_.Fail(time_s_, "a time in seconds");
    return std::llround(time_ns);
  }

  [[nodiscard]] Rigid3 Pose() const {
    std::array<double, 7> cells{};
    for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = csv_.Number(pose_[i]);
    const Eigen::Quaterniond rotation(cells[0], cells[1], cells[2], cells[3]);
    constexpr double kNormTolerance = 1e-3;  // as for the quaternions of a rig
    if (std::abs(rotation.norm() - 1) > kNormTolerance) {
      csv_.Fail("qw, qx, qy, qz: found a norm of " + std::to_string(rotation.norm()) +
                ", expected a unit quaternion");
    }
    return {WithPositiveW(rotation.normalized()), {cells[4], cells[5], cells[6]}};
  }

  [[nodiscard]] Eigen::Vector3d FreeAxis() const {
    const Eigen::Vector3d axis(csv_.Number(free_[0]), csv_.Number(free_[1]), csv_.Number(free_[2]));
    constexpr double kNormTolerance = 1e-3;
    if (std::abs(axis.norm() - 1) > kNormTolerance) {
      csv_.Fail("free_x, free_y, free_z: found no unit vector");
    }
    return axis.normalized();
  }

  // Of a free axis the covariance is singular, of all others it must not be.
  [[nodiscard]] Matrix6d Covariance(bool singular) const {
    Matrix6d covariance;
    std::size_t next = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        covariance(i, j) = covariance(j, i) = csv_.Number(covariance_[next++]);
      }
    }
    Vector6d scale = covariance.diagonal().cwiseMax(0).cwiseSqrt();
    for (double& one : scale) one = one > 0 ? 1 / one : 1;
    const Matrix6d correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(correlation, Eigen::EigenvaluesOnly);
    constexpr double kTenDigits = 1e-8;  // what is left of zero in a file of ten digits
    if (solver.eigenvalues().minCoeff() < (singular ? -kTenDigits : 0)) {
      csv_.Fail(std::string("cov_00 to cov_55: found a covariance that is not positive ") +
                (singular ? "semi-definite" : "definite"));
    }
    return covariance;
  }

  CsvStream csv_;
  int frame_ = -1, status_ = -1, time_ns_ = -1, time_s_ = -1;
  std::vector<int> pose_, covariance_, calibration_, free_;
};

}  // namespace

PoseSeries ReadPosesCsv(const std::filesystem::path& file) { return PosesFile(file).ReadAll(); }

bool HasCovariances(const PoseSeries& series) {
  for (const PoseSample& pose : series) {
    if (pose.measured && pose.covariance.isZero(0)) return false;
  }
  return true;
}

}  // namespace stereomotion
