#include "stereomotion/calibration/calibrate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <set>
#include <stdexcept>

#include "check_rig.h"
#include "circle_size.h"
#include "diagnose_calibration.h"
#include "drop_undetermined.h"
#include "fit_board_shape.h"
#include "fit_bundle.h"
#include "plan_intrinsics.h"
#include "start_bundle.h"

namespace stereomotion {
namespace {

constexpr int kLeastControlPoints = 6;
// Third extent of the points against the first: flatter, and a DLT is noise.
constexpr double kFlat = 0.01;
// Distance from the origin against the points' extent (their singular value): further away turning
// and shifting a camera are one, to all the digits that there are.
constexpr double kFarOrigin = 200;

// Coordinates in the axes that `world` lays through three of the points.
Rigid3 WorldFromPoints(const std::vector<TargetPoint>& points, const WorldPoints& world) {
  const Eigen::Vector3d origin = points[world.origin].xyz_mm;
  const Eigen::Vector3d x = (points[world.x_axis].xyz_mm - origin).normalized();
  const Eigen::Vector3d in_plane = points[world.xy_plane].xyz_mm - origin;
  const Eigen::Vector3d z = x.cross(in_plane).normalized();
  Eigen::Matrix3d axes;
  axes << x, z.cross(x), z;
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(axes.transpose()));
  return {rotation, -(rotation * origin)};
}

CalibrationSetup InWorld(CalibrationSetup setup) {
  auto& points = setup.world_points.empty() ? setup.target.points : setup.world_points;
  if (!setup.world) return setup;
  const Rigid3 world_from_points = WorldFromPoints(points, *setup.world);
  for (auto& point : points) point.xyz_mm = world_from_points * point.xyz_mm;
  return setup;
}

std::optional<CalibrationNote> CheckControlPoints(
    const CalibrationSetup& setup, const std::vector<TargetObservation>& observations) {
  for (std::size_t c = 0; c < setup.cameras.size(); ++c) {
    std::set<int> seen;
    for (const auto& o : observations) {
      if (o.camera == static_cast<int>(c)) seen.insert(o.point);
    }
    const std::string& name = setup.cameras[c].name;
    if (seen.size() < kLeastControlPoints) {
      return CalibrationNote{"too_few_points",
                             fmt::format("camera {}: sees {} control points, expected at least {}",
                                         name, seen.size(), kLeastControlPoints)};
    }
    Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(seen.size()));
    Eigen::Index column = 0;
    for (const int point : seen) points.col(column++) = setup.target.points[point].xyz_mm;
    const double offset_mm = points.rowwise().mean().norm();
    points.colwise() -= points.rowwise().mean().eval();
    const Eigen::Vector3d extent = Eigen::JacobiSVD<Eigen::Matrix3Xd>(points).singularValues();
    if (offset_mm > kFarOrigin * extent[0]) {
      return CalibrationNote{
          "large_offset",
          fmt::format("the control points lie {:.0f} m from their coordinates' origin, which costs "
                      "the digits that tell a camera's place; subtract an offset from all "
                      "coordinates, or lay the axes through three of them (`world:`)",
                      offset_mm / 1000)};
    }
    if (extent[2] > kFlat * extent[0]) continue;
    return CalibrationNote{
        "coplanar", fmt::format("camera {}: the {} control points that it sees lie in a plane (to "
                                "{:.2g} of their extent), which does not determine a camera; add "
                                "points off the plane",
                                name, seen.size(), extent[2] / extent[0])};
  }
  return std::nullopt;
}

BundleStart Start(const CalibrationSetup& setup, const BundleProblem& plan) {
  switch (setup.target.type) {
    case TargetType::kControlPoints:
      return StartControlPoints(setup, plan);
    case TargetType::kWand:
      return StartWand(setup, plan);
    default:
      return StartBoards(setup, plan);
  }
}

// A board without stated σ is believed only as long as the residuals allow it.
bool IsTakenAsExact(const Target& target) {
  return IsBoard(target.type) && std::all_of(target.points.begin(), target.points.end(),
                                             [](const auto& p) { return p.sigma_mm == 0; });
}

BundleProblem WithCircles(BundleProblem problem, double radius_mm) {
  for (auto& point : problem.points) point.circle_radius_mm = radius_mm;
  return problem;
}

// Adjusts everything that the images determine.
Expected<FittedBundle, BundleFailure> FitDeterminable(
    const CalibrationSetup& setup, const std::vector<TargetObservation>& observations,
    const std::vector<RigCamera>& kept, BundleProblem problem, const FitOptions& options,
    std::vector<CalibrationNote>& notes) {
  auto fit = FitBundle(problem, options);
  while (fit && DropUndetermined(*fit, kept, problem, notes)) fit = FitBundle(problem, options);
  const bool circles = setup.target.type == TargetType::kCircleGrid;
  if (fit && circles && setup.target.ball_diameter_mm == 0) {
    fit = FitBundle(WithCircles(problem, EstimateCircleRadius(*fit, observations)), options);
  }
  return fit;
}

// A flat board in one or two views fits any lens.
std::optional<CalibrationNote> CheckViews(const CalibrationSetup& setup,
                                          const BundleProblem& start) {
  constexpr std::size_t kLeast = 3;  // Zhang 2000
  const bool lens_known =
      std::all_of(start.intrinsic_unknown.begin(), start.intrinsic_unknown.end(),
                  [](const auto& unknown) { return unknown[0] < 0 && unknown[1] < 0; });
  if (setup.target.type == TargetType::kControlPoints || lens_known) return std::nullopt;
  std::set<int> views;
  for (const auto& o : start.observations) {
    if (o.used) views.insert(o.view);
  }
  if (views.size() >= kLeast) return std::nullopt;
  return CalibrationNote{"too_few_views",
                         fmt::format("the target was found in {} view(s), expected at least {}; 10 "
                                     "to 30 make a good calibration",
                                     views.size(), kLeast)};
}

// A focal length that could as well be half or twice as long.
std::optional<CalibrationNote> RefuseLens(const FittedBundle& fit) {
  constexpr double kUnknown = 0.3;
  const RigCovariance& covariance = fit.solution.rig_covariance;
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(covariance.parameters.size()); ++i) {
    const RigParameter& parameter = covariance.parameters[i];
    if (parameter.index != 0) continue;
    const RigCamera& camera = fit.solution.cameras[parameter.camera];
    const double sigma = std::sqrt(covariance.matrix(i, i)) / camera.model.fx_px;
    if (sigma < kUnknown) continue;
    return CalibrationNote{
        "undetermined", fmt::format("camera {}: the images leave the focal length open ({:.0f} px "
                                    "± {:.0f} %): more views, tilt and depth, right pairs, or "
                                    "`initial` and `free` without fx and fy",
                                    camera.name, camera.model.fx_px, 100 * sigma)};
  }
  return std::nullopt;
}

// A rig that is plainly wrong must not be written, whatever warnings come with it.
std::optional<CalibrationNote> RefuseMisfit(const CalibrationSetup& setup, const FittedBundle& fit,
                                            const CalibrateOptions& options) {
  constexpr double kWorstScale = 50;    // of a stated σ: no detector and no survey errs so much
  constexpr double kWorstBoard = 0.02;  // of the board's extent: not paper, but other numbers
  if (options.image_sigma_known && fit.image_sigma_scale > kWorstScale) {
    return CalibrationNote{
        "no_fit",
        fmt::format("no cameras fit the images: their points scatter {:.0f} times as much "
                    "as the detector states; wrong target lengths, `initial` values, "
                    "pairs of images, or a second object?",
                    fit.image_sigma_scale)};
  }
  if (fit.survey_sigma_scale > kWorstScale && !IsBoard(setup.target.type)) {
    return CalibrationNote{
        "no_fit",
        fmt::format("no cameras fit the survey: its points scatter {:.0f} times as much as "
                    "their sigma_mm states; wrong coordinates, ids or `initial` values?",
                    fit.survey_sigma_scale)};
  }
  double off_mm = 0, extent_mm = 0;
  for (const BundlePoint& point : fit.solution.points) {
    off_mm = std::max(off_mm, (point.xyz_mm - point.surveyed_mm).norm());
    extent_mm =
        std::max(extent_mm, (point.surveyed_mm - fit.solution.points[0].surveyed_mm).norm());
  }
  // Surveyed points hold the measuring volume together whatever the focal length is.
  if (setup.target.type == TargetType::kControlPoints) return std::nullopt;
  if (!IsBoard(setup.target.type) || off_mm < kWorstBoard * extent_mm) return RefuseLens(fit);
  return CalibrationNote{
      "wrong_board",
      fmt::format("the board's points lie up to {:.1f} mm from where frame.yaml puts "
                  "them: rows, cols, sizes, spacing or first_id of another board?",
                  off_mm)};
}

int FixedView(const BundleProblem& problem) {
  for (int view = 0; view < static_cast<int>(problem.views.size()); ++view) {
    if (problem.views[view].freedom == PoseFreedom::kFixed) return view;
  }
  return -1;
}

// A board's world is view 0, unless that view gave nothing.
std::optional<CalibrationNote> NoteWorldView(const CalibrationSetup& setup,
                                             const FittedBundle& fit) {
  const int view = FixedView(fit.problem);
  if (!IsBoard(setup.target.type) || view <= 0) return std::nullopt;
  return CalibrationNote{"world_view",
                         fmt::format("view 0 does not show the board well enough: the world is the "
                                     "board in view {}",
                                     view)};
}

CalibrationNote Explain(const BundleFailure& failure) {
  switch (failure.reason) {
    case BundleFailure::Reason::kUndetermined:
      return {"undetermined",
              fmt::format("the images do not determine {}: move the target through the whole "
                          "volume and tilt it, or give `initial` values and leave these out of "
                          "`free`",
                          fmt::join(failure.parameters, ", "))};
    case BundleFailure::Reason::kTooFewObservations:
      return {"too_few_points",
              "there are fewer observations than unknowns; show the target more "
              "often, or estimate less (`free`)"};
    default:
      return {"no_convergence", "the adjustment found no solution from its start values"};
  }
}

Calibration Collect(const FittedBundle& fit) {
  const BundleSolution& solution = fit.solution;
  Calibration result;
  result.rig.cameras = solution.cameras;
  result.rig.covariance = solution.rig_covariance;
  for (const RigParameter& parameter : solution.rig_covariance.parameters) {
    result.free_parameters.push_back(RigParameterName(result.rig, parameter));
  }
  result.view_used.assign(solution.views.size(), false);
  double squared = 0;
  int used = 0;
  for (std::size_t i = 0; i < fit.problem.observations.size(); ++i) {
    const BundleObservation& o = fit.problem.observations[i];
    result.residuals.push_back({o.camera, o.view, o.point, o.pixel_px, solution.residuals_px[i],
                                solution.normalized[i], o.used});
    if (!o.used) continue;
    result.view_used[o.view] = true;
    squared += solution.residuals_px[i].squaredNorm();
    ++used;
  }
  for (const auto& view : solution.views)
    result.world_from_target.push_back(view.world_from_target);
  for (const auto& point : solution.points) result.points_mm.push_back(point.xyz_mm);
  result.rms_px = used > 0 ? std::sqrt(squared / (2 * used)) : 0;
  const double redundancy = solution.image_redundancy + solution.survey_redundancy;
  result.dof = static_cast<int>(std::lround(redundancy));
  const double chi2 = solution.image_chi2 + solution.survey_chi2;
  result.chi2_dof = redundancy > 0 ? chi2 / redundancy : 0;
  result.image_sigma_scale = fit.image_sigma_scale;
  result.survey_sigma_scale = fit.survey_sigma_scale;
  return result;
}

void CheckArguments(const CalibrationSetup& setup,
                    const std::vector<TargetObservation>& observations) {
  const auto points = setup.target.points.size() + setup.world_points.size();
  for (const auto& o : observations) {
    const bool known = o.camera >= 0 && o.camera < static_cast<int>(setup.cameras.size()) &&
                       o.point >= 0 && o.point < static_cast<int>(points) && o.view >= 0;
    if (!known) throw std::invalid_argument("Calibrate: an observation names what is not there");
    const double determinant = o.covariance_px2.determinant();
    if (!o.pixel_px.allFinite() || !(determinant > 0) || !(o.covariance_px2(0, 0) > 0)) {
      throw std::invalid_argument("Calibrate: an observation's numbers cannot be meant");
    }
  }
  if (setup.cameras.size() < 2) throw std::invalid_argument("Calibrate: fewer than two cameras");
}

}  // namespace

Expected<Calibration, CalibrationNote> Calibrate(const CalibrationSetup& asked,
                                                 const std::vector<TargetObservation>& observations,
                                                 const CalibrateOptions& options) {
  CheckArguments(asked, observations);
  const auto tell = [&](const std::string& what) {
    if (options.progress) options.progress(what);
  };
  const CalibrationSetup setup = InWorld(asked);
  std::vector<TargetObservation> fitted, kept_out;
  for (const auto& o : observations) {
    const bool check =
        std::count(setup.check_points.begin(), setup.check_points.end(), o.point) > 0;
    (check ? kept_out : fitted).push_back(o);
  }
  const bool surveyed = setup.target.type == TargetType::kControlPoints;
  if (surveyed) {
    if (auto problem = CheckControlPoints(setup, fitted)) return Unexpected{std::move(*problem)};
  }
  const IntrinsicsPlan plan = PlanIntrinsics(setup, fitted);
  tell("finding first values");
  const BundleProblem laid_out = LayOutBundle(setup, fitted, plan.unknown);
  const BundleStart start = Start(setup, laid_out);
  if (!start) return Unexpected{start.error()};
  if (auto problem = CheckViews(setup, *start)) return Unexpected{std::move(*problem)};
  tell("adjusting cameras and target together");
  FitOptions fit_options;
  fit_options.image_sigma_known = options.image_sigma_known;
  std::vector<CalibrationNote> notes = plan.notes;
  auto fit = FitDeterminable(setup, fitted, laid_out.cameras, *start, fit_options, notes);
  if (!fit) return Unexpected{Explain(fit.error())};
  if (IsTakenAsExact(setup.target)) {
    tell("looking for the board's own shape");
    fit = FitBoardShape(*fit, fit_options);
  }

  if (auto refusal = RefuseUnits(setup, fitted, *fit)) return Unexpected{std::move(*refusal)};
  if (auto refusal = RefuseMisfit(setup, *fit, options)) return Unexpected{std::move(*refusal)};

  Calibration result = Collect(*fit);
  tell("checking the rig");
  if (!kept_out.empty()) {
    auto sights = LayOutBundle(setup, kept_out, plan.unknown).observations;
    for (auto& sight : sights)
      sight.covariance_px2 *= fit->image_sigma_scale * fit->image_sigma_scale;
    result.check_points = CheckPoints(*fit, fit->problem.points, sights);
  }
  if (surveyed && options.folds > 1) result.cross_validation = CrossValidate(*fit, options.folds);
  result.volume = MapVolume(*fit);
  if (const auto moved = NoteWorldView(setup, *fit)) notes.push_back(*moved);
  result.warnings = std::move(notes);
  for (auto& note : DiagnoseCalibration(setup, fitted, *fit)) {
    result.warnings.push_back(std::move(note));
  }
  return result;
}

}  // namespace stereomotion
