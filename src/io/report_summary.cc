#include "report_summary.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "report_verdict.h"
#include "stereomotion/core/median.h"

namespace stereomotion {
namespace {

// An image that fits this many times worse than the camera's usual one is looked at by a person.
constexpr double kOutlying = 2;

bool Within(int index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

void Expect(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("calibration report: ") + what);
}

void CheckArguments(const Calibration& calibration, const CalibrationSetup& setup,
                    const CalibrationInputs& inputs) {
  const std::size_t cameras = setup.cameras.size();
  const std::size_t views = calibration.world_from_target.size();
  const std::size_t points = setup.target.points.size() + setup.world_points.size();
  Expect(calibration.rig.cameras.size() == cameras, "the rig has other cameras than the setup");
  Expect(calibration.view_used.size() == views, "view_used does not fit the views");
  Expect(calibration.points_mm.size() <= points, "more points than the target has");
  for (const auto& r : calibration.residuals) {
    Expect(Within(r.camera, cameras) && Within(r.view, views) && Within(r.point, points),
           "a residual names what is not there");
  }
  for (const auto& check : calibration.check_points) {
    Expect(Within(check.point, points), "a check point is not a point of the target");
  }
  if (const auto& covariance = calibration.rig.covariance) {
    const auto size = static_cast<Eigen::Index>(covariance->parameters.size());
    Expect(covariance->matrix.rows() == size && covariance->matrix.cols() == size,
           "the covariance does not fit its parameters");
  }
  Expect(inputs.images.empty() || inputs.images.size() == cameras, "images of other cameras");
  Expect(inputs.blur_px.empty() || inputs.blur_px.size() == cameras, "blur of other cameras");
}

void MarkOutlying(CalibrationSummary& summary) {
  summary.outlying.assign(summary.views.size(), std::vector<bool>(summary.cameras.size(), false));
  for (std::size_t c = 0; c < summary.cameras.size(); ++c) {
    std::vector<double> all_px;
    for (const auto& view : summary.images) {
      if (const auto rms_px = view[c].RmsPx()) all_px.push_back(*rms_px);
    }
    const double usual_px = all_px.empty() ? 0 : Median(all_px);
    for (std::size_t v = 0; v < summary.images.size(); ++v) {
      const ResidualCount& image = summary.images[v][c];
      summary.outlying[v][c] =
          image.left_out > image.used || image.RmsPx().value_or(0) > kOutlying * usual_px;
    }
  }
}

void SummariseVolume(const Calibration& calibration, CalibrationSummary& summary) {
  std::vector<double> random, common;
  for (const VolumeSigma& place : calibration.volume) {
    random.push_back(place.random_mm);
    common.push_back(place.calibration_mm);
  }
  if (random.empty()) return;
  summary.random_mm = {Median(random), *std::max_element(random.begin(), random.end())};
  summary.calibration_mm = {Median(common), *std::max_element(common.begin(), common.end())};
}

void SummariseCheckPoints(const Calibration& calibration, CalibrationSummary& summary) {
  double squared = 0, expected = 0;
  const auto count = static_cast<int>(calibration.check_points.size());
  if (count == 0) return;
  for (const CheckPoint& check : calibration.check_points) {
    squared += check.error_mm.squaredNorm();
    expected += check.covariance_mm2.trace();
  }
  summary.check_points = {count, std::sqrt(squared / count), std::sqrt(expected / count)};
}

}  // namespace

void ResidualCount::Add(const CalibrationResidual& residual) {
  ++(residual.used ? used : left_out);
  if (residual.used) sum_px2 += residual.residual_px.squaredNorm();
}

std::optional<double> ResidualCount::RmsPx() const {
  if (used == 0) return std::nullopt;
  return std::sqrt(sum_px2 / (2 * used));
}

CalibrationSummary Summarise(const Calibration& calibration, const CalibrationSetup& setup,
                             const CalibrationInputs& inputs) {
  CheckArguments(calibration, setup, inputs);
  CalibrationSummary summary;
  summary.cameras.resize(setup.cameras.size());
  summary.views.resize(calibration.world_from_target.size());
  summary.images.assign(summary.views.size(), std::vector<ResidualCount>(setup.cameras.size()));
  for (const auto& residual : calibration.residuals) {
    summary.cameras[residual.camera].Add(residual);
    summary.views[residual.view].Add(residual);
    summary.images[residual.view][residual.camera].Add(residual);
  }
  MarkOutlying(summary);
  SummariseVolume(calibration, summary);
  SummariseCheckPoints(calibration, summary);
  summary.level = Judge(calibration, summary);
  return summary;
}

const std::string& PointId(const CalibrationSetup& setup, int point) {
  const auto own = static_cast<int>(setup.target.points.size());
  return point < own ? setup.target.points[point].id : setup.world_points.at(point - own).id;
}

std::string ImageName(const CalibrationInputs& inputs, int camera, int view) {
  const bool known =
      Within(camera, inputs.images.size()) && Within(view, inputs.images[camera].size());
  return known ? inputs.images[camera][view] : std::string();
}

std::optional<double> BlurPx(const CalibrationInputs& inputs, int camera, int view) {
  const bool known = Within(camera, inputs.blur_px.size()) &&
                     Within(view, inputs.blur_px[camera].size()) &&
                     inputs.blur_px[camera][view] > 0;
  return known ? std::optional(inputs.blur_px[camera][view]) : std::nullopt;
}

std::optional<double> ErrorInSigmas(const CheckPoint& check) {
  const Eigen::LLT<Eigen::Matrix3d> root(check.covariance_mm2);
  if (root.info() != Eigen::Success) return std::nullopt;
  return root.matrixL().solve(check.error_mm).norm();
}

ParameterSpread SpreadOfParameters(const Rig& rig) {
  ParameterSpread spread;
  if (!rig.covariance) return spread;
  const Eigen::MatrixXd& m = rig.covariance->matrix;
  for (const auto& parameter : rig.covariance->parameters) {
    spread.names.push_back(RigParameterName(rig, parameter));
  }
  spread.sigma = m.diagonal().cwiseMax(0).cwiseSqrt();
  spread.correlation = Eigen::MatrixXd::Identity(m.rows(), m.cols());
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
      const double scale = spread.sigma[i] * spread.sigma[j];
      if (i != j && scale > 0) spread.correlation(i, j) = m(i, j) / scale;
    }
  }
  return spread;
}

}  // namespace stereomotion
