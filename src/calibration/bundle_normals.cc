#include "bundle_normals.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "bundle_prior.h"
#include "bundle_row.h"
#include "predict_image.h"

namespace stereomotion {
namespace {

Eigen::Matrix2d Whitening(const Eigen::Matrix2d& covariance) {
  const Eigen::Matrix2d lower = covariance.llt().matrixL();
  return lower.inverse();
}

double HuberCost(double length, double huber) {
  return length <= huber ? length * length : huber * (2 * length - huber);
}

void Accumulate(const ObservationRow& row, const Eigen::Matrix2d& weight, const Eigen::Vector2d& r,
                BundleNormals& normals) {
  const Eigen::Matrix<double, 2, ObservationRow::kMaxGlobal> weighted = weight * row.global;
  for (int i = 0; i < row.num_global; ++i) {
    normals.rhs[row.unknown[i]] += weighted.col(i).dot(r);
    for (int j = 0; j < row.num_global; ++j) {
      normals.global(row.unknown[i], row.unknown[j]) += weighted.col(i).dot(row.global.col(j));
    }
  }
  if (row.block < 0) return;
  BundleNormals::Block& block = normals.blocks[row.block];
  const Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 6, 2> local = row.local.transpose() * weight;
  block.local += local * row.local;
  block.rhs += local * r;
  for (int i = 0; i < row.num_global; ++i) {
    block.cross.col(row.unknown[i]) += local * row.global.col(i);
  }
}

void AddSurvey(const BundleProblem& problem, const BundleUnknowns& unknowns,
               BundleNormals& normals) {
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    const BundlePoint& point = problem.points[p];
    int column = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma_mm = point.sigma_mm[axis];
      if (!(sigma_mm > 0)) continue;
      const double weight = 1 / (sigma_mm * sigma_mm);  // zero for an infinite σ
      const double rhs =
          std::isinf(sigma_mm) ? 0 : weight * (point.surveyed_mm[axis] - point.xyz_mm[axis]);
      const int place = column++;
      if (unknowns.point_global[p] >= 0) {
        const int unknown = unknowns.point_global[p] + place;
        normals.global(unknown, unknown) += weight;
        normals.rhs[unknown] += rhs;
      } else {
        BundleNormals::Block& block = normals.blocks[unknowns.point_block[p]];
        block.local(place, place) += weight;
        block.rhs[place] += rhs;
      }
    }
  }
}

double SurveyChi2(const BundleProblem& problem) {
  double chi2 = 0;
  for (const BundlePoint& point : problem.points) {
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma_mm = point.sigma_mm[axis];
      if (!(sigma_mm > 0) || std::isinf(sigma_mm)) continue;
      const double z = (point.xyz_mm[axis] - point.surveyed_mm[axis]) / sigma_mm;
      chi2 += z * z;
    }
  }
  return chi2;
}

BundleNormals MakeEmpty(const BundleUnknowns& unknowns) {
  BundleNormals normals;
  normals.global.setZero(unknowns.num_global, unknowns.num_global);
  normals.rhs.setZero(unknowns.num_global);
  for (const int size : unknowns.block_size) {
    normals.blocks.push_back({Eigen::MatrixXd::Zero(size, size),
                              Eigen::MatrixXd::Zero(size, unknowns.num_global),
                              Eigen::VectorXd::Zero(size)});
  }
  return normals;
}

}  // namespace

BundleResiduals EvaluateResiduals(const BundleProblem& problem, double huber) {
  BundleResiduals result;
  result.survey_chi2 = SurveyChi2(problem);
  result.prior_chi2 = PriorChi2(problem);
  result.cost = result.survey_chi2 + result.prior_chi2;
  for (const BundleObservation& observation : problem.observations) {
    const auto image = PredictImage(problem.cameras[observation.camera],
                                    problem.views[observation.view].world_from_target,
                                    problem.points[observation.point]);
    Eigen::Vector2d residual = Eigen::Vector2d::Zero();
    double length = std::numeric_limits<double>::infinity();
    if (image) {
      residual = observation.pixel_px - image->pixel_px;
      length = (Whitening(observation.covariance_px2) * residual).norm();
    }
    result.residuals_px.push_back(residual);
    result.normalized.push_back(length);
    if (!observation.used) continue;
    result.image_chi2 += length * length;
    result.cost += HuberCost(length, huber);
  }
  return result;
}

BundleNormals AssembleNormals(const BundleProblem& problem, const BundleUnknowns& unknowns,
                              double huber) {
  BundleNormals normals = MakeEmpty(unknowns);
  normals.cost = SurveyChi2(problem) + PriorChi2(problem);
  for (const BundleObservation& observation : problem.observations) {
    if (!observation.used) continue;
    const auto image = PredictImage(problem.cameras[observation.camera],
                                    problem.views[observation.view].world_from_target,
                                    problem.points[observation.point]);
    if (!image) {
      normals.cost = std::numeric_limits<double>::infinity();
      return normals;
    }
    const Eigen::Vector2d residual = observation.pixel_px - image->pixel_px;
    const Eigen::Matrix2d whitening = Whitening(observation.covariance_px2);
    const double length = (whitening * residual).norm();
    normals.cost += HuberCost(length, huber);
    const double robust = length <= huber ? 1 : huber / length;
    Accumulate(MakeRow(problem, unknowns, observation, *image),
               robust * whitening.transpose() * whitening, residual, normals);
  }
  AddSurvey(problem, unknowns, normals);
  AddPrior(problem, unknowns, normals);
  return normals;
}

}  // namespace stereomotion
