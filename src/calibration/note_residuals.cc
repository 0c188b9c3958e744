#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "diagnose_calibration.h"

namespace stereomotion {
namespace {

const TargetPoint& PointOf(const CalibrationSetup& setup, int point) {
  const auto own = static_cast<int>(setup.target.points.size());
  return point < own ? setup.target.points[point] : setup.world_points[point - own];
}

Eigen::Vector2d PredictedPx(const FittedBundle& fit, std::size_t i) {
  return fit.problem.observations[i].pixel_px - fit.solution.residuals_px[i];
}

// Two outliers of one image, each where the other one is expected: their ids are exchanged.
std::string FindExchange(const CalibrationSetup& setup, const FittedBundle& fit,
                         const std::vector<std::size_t>& outliers, std::size_t i) {
  const auto& o = fit.problem.observations[i];
  for (const std::size_t j : outliers) {
    const auto& other = fit.problem.observations[j];
    if (j == i || other.camera != o.camera || other.view != o.view) continue;
    const double own = fit.solution.residuals_px[i].norm();
    const double exchanged = (o.pixel_px - PredictedPx(fit, j)).norm();
    if (exchanged < own / 5) {  // plainly nearer
      return fmt::format("; it lies where {} is expected: ids exchanged?",
                         PointOf(setup, other.point).id);
    }
  }
  return "";
}

std::string Describe(const CalibrationSetup& setup, const FittedBundle& fit,
                     const std::vector<std::size_t>& outliers, std::size_t i) {
  const auto& o = fit.problem.observations[i];
  if (std::isinf(fit.solution.normalized[i])) {
    return fmt::format("{} in camera {}, view {}: the camera cannot see it there",
                       PointOf(setup, o.point).id, setup.cameras[o.camera].name, o.view);
  }
  return fmt::format("{} in camera {}, view {}: {:.2f} px off{}", PointOf(setup, o.point).id,
                     setup.cameras[o.camera].name, o.view, fit.solution.residuals_px[i].norm(),
                     FindExchange(setup, fit, outliers, i));
}

// The mean residual of each cell of the image against what white noise leaves.
struct CellTest {
  double chi2 = 0;
  int dof = 0;
  double systematic_px = 0;  // RMS of the cell means, noise removed
};

struct Cell {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
};

// A point of a static frame that several images show errs the same way in all: one vote.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> IndependentResiduals(
    const FittedBundle& fit, int camera, bool static_frame) {
  std::map<std::pair<int, int>, std::pair<Cell, Cell>> sums;
  for (std::size_t i = 0; i < fit.problem.observations.size(); ++i) {
    const auto& o = fit.problem.observations[i];
    if (o.camera != camera || !o.used) continue;
    auto& [place, residual] = sums[{static_frame ? 0 : o.view, o.point}];
    place.sum += o.pixel_px;
    residual.sum += fit.solution.residuals_px[i];
    ++place.count;
  }
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> residuals;
  for (const auto& [key, sum] : sums) {
    residuals.emplace_back(sum.first.sum / sum.first.count, sum.second.sum / sum.first.count);
  }
  return residuals;
}

CellTest TestCells(const FittedBundle& fit, int camera, bool static_frame) {
  constexpr int kPerCell = 12;
  const auto residuals = IndependentResiduals(fit, camera, static_frame);
  const int cells = static_cast<int>(std::sqrt(static_cast<double>(residuals.size()) / kPerCell));
  CellTest test;
  if (cells < 3) return test;
  const RigCamera& lens = fit.solution.cameras[camera];
  std::map<int, Cell> grid;
  double squared = 0;
  for (const auto& [place, residual] : residuals) {
    const int column = static_cast<int>(cells * place.x() / lens.width_px);
    const int row = static_cast<int>(cells * place.y() / lens.height_px);
    Cell& cell = grid[row * cells + column];
    cell.sum += residual;
    ++cell.count;
    squared += residual.squaredNorm();
  }
  const double count = static_cast<double>(residuals.size());
  const double variance = squared / (2 * count);
  double between = 0;
  for (const auto& [place, cell] : grid) {
    test.chi2 += cell.sum.squaredNorm() / cell.count / variance;
    test.dof += 2;
    between += cell.sum.squaredNorm() / cell.count - 2 * variance;
  }
  test.systematic_px = std::sqrt(std::max(0.0, between / (2 * count)));
  return test;
}

// Views of which most was left out: the cameras contradict each other there.
void NoteLostViews(const FittedBundle& fit, std::vector<CalibrationNote>& notes) {
  std::map<int, std::pair<int, int>> used_of;
  for (const auto& o : fit.problem.observations) {
    used_of[o.view].first += o.used ? 1 : 0;
    ++used_of[o.view].second;
  }
  for (const auto& [view, counts] : used_of) {
    if (2 * counts.first >= counts.second) continue;
    notes.push_back({"contradicting_view",
                     fmt::format("view {}: {} of {} image points were left out: the cameras "
                                 "contradict each other there; images of different moments, or a "
                                 "target that moved?",
                                 view, counts.second - counts.first, counts.second)});
  }
}

void NoteBoardShape(const CalibrationSetup& setup, const FittedBundle& fit,
                    std::vector<CalibrationNote>& notes) {
  double worst_mm = 0;
  int worst = 0;
  for (int p = 0; p < static_cast<int>(fit.solution.points.size()); ++p) {
    const BundlePoint& point = fit.solution.points[p];
    const double off_mm = (point.xyz_mm - point.surveyed_mm).norm();
    if (off_mm > worst_mm) worst = p;
    worst_mm = std::max(worst_mm, off_mm);
  }
  if (worst_mm == 0) return;
  notes.push_back({"board_shape",
                   fmt::format("the board is not as flat or as evenly printed as it should be: its "
                               "points were estimated, too, and lie up to {:.2g} mm off (point "
                               "{}); the scale still is the board's nominal one",
                               worst_mm, PointOf(setup, worst).id)});
}

}  // namespace

void NoteOutliers(const CalibrationSetup& setup, const FittedBundle& fit,
                  std::vector<CalibrationNote>& notes) {
  constexpr std::size_t kListed = 8;
  std::vector<std::size_t> outliers;
  for (std::size_t i = 0; i < fit.problem.observations.size(); ++i) {
    if (!fit.problem.observations[i].used) outliers.push_back(i);
  }
  if (outliers.empty()) return;
  NoteLostViews(fit, notes);
  const auto size = [&](std::size_t i) {  // what cannot be projected has no residual: worst of all
    return std::isinf(fit.solution.normalized[i]) ? 1e9 : fit.solution.residuals_px[i].norm();
  };
  std::stable_sort(outliers.begin(), outliers.end(),
                   [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < std::min(kListed, outliers.size()); ++k) {
    lines.push_back(Describe(setup, fit, outliers, outliers[k]));
  }
  if (outliers.size() > kListed) {
    lines.push_back(
        fmt::format("and {} more (calibration.json lists all)", outliers.size() - kListed));
  }
  notes.push_back({"outliers", fmt::format("{} of {} image points do not fit and were left out: {}",
                                           outliers.size(), fit.problem.observations.size(),
                                           fmt::join(lines, "; "))});
}

void NoteResiduals(const CalibrationSetup& setup, const FittedBundle& fit,
                   std::vector<CalibrationNote>& notes) {
  constexpr double kPlain = 5;  // standard deviations
  const bool static_frame = setup.target.type == TargetType::kControlPoints;
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    const CellTest test = TestCells(fit, static_cast<int>(c), static_frame);
    if (test.dof == 0) continue;
    const double z = (test.chi2 - test.dof) / std::sqrt(2.0 * test.dof);
    if (z < kPlain) continue;
    notes.push_back(
        {"systematic_residuals",
         fmt::format(
             "camera {}: systematic residuals: refraction or a wrong lens model (`free` too "
             "short?), or a camera that moved in between; neighbouring points err alike, by {:.3f} "
             "px (RMS), {:.0f} standard deviations "
             "beyond chance, so that the stated covariance is too small",
             setup.cameras[c].name, test.systematic_px, z)});
  }
  const double scale = fit.image_sigma_scale;
  if (HasBalls(setup.target.type) && scale > 1.5) {
    notes.push_back(
        {"image_noise", fmt::format("the image points scatter {:.1f} times as much as the detector "
                                    "states; the rig's covariance is scaled with that",
                                    scale)});
  }
  if (IsBoard(setup.target.type)) NoteBoardShape(setup, fit, notes);
  const bool surveyed = setup.target.type == TargetType::kControlPoints;
  if (!surveyed) return;
  if (fit.survey_sigma_scale > 1.5 || fit.survey_sigma_scale < 1 / 1.5) {
    notes.push_back({"survey_sigma",
                     fmt::format("the surveyed coordinates scatter {:.2f} times as much as their "
                                 "sigma_mm states; the rig's covariance is scaled with that",
                                 fit.survey_sigma_scale)});
  }
}

}  // namespace stereomotion
