#include "motion/condense_frames.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <optional>

namespace stereomotion {
namespace {

constexpr int kMaxIterations = 20;
/// A step of the whitened pose smaller than this is rounding, not information [σ].
constexpr double kConverged_sigma = 1e-7;
/// Singular values of the scaled Jacobian below this share of the largest are rounding.
constexpr double kRankTolerance = 1e-9;
constexpr Eigen::Index kPose = 6, kFreeTurn = 5;

struct PoseStep {
  Vector6d delta;
  double length_sigma = 0;
  Eigen::MatrixXd whitener;  ///< rank × 6
};

/// Solves the frame's normal equations without a pose's open directions.
PoseStep Step(const FrameEquations& equations) {
  const Vector6d scale = equations.d_pose.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::MatrixXd scaled = equations.d_pose * scale.asDiagonal();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(scaled);
  const Eigen::Index rows = std::min(kPose, scaled.rows());
  const Eigen::MatrixXd r = qr.matrixQR().topRows(rows).triangularView<Eigen::Upper>();
  Eigen::VectorXd y = qr.householderQ().adjoint() * equations.residual;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeThinU | Eigen::ComputeThinV);
  Eigen::Index rank = 0;
  const auto& values = svd.singularValues();
  while (rank < values.size() && values[rank] > kRankTolerance * values[0]) ++rank;
  const Eigen::VectorXd along = svd.matrixU().leftCols(rank).adjoint() * y.head(rows);
  PoseStep step;
  step.length_sigma = along.norm();
  const Eigen::VectorXd shrunk = along.cwiseQuotient(values.head(rank));
  step.delta = -(scale.asDiagonal() * (svd.matrixV().leftCols(rank) * shrunk));
  step.whitener = values.head(rank).asDiagonal() * svd.matrixV().leftCols(rank).transpose() *
                  scale.cwiseInverse().asDiagonal();
  return step;
}

struct OwnPose {
  ObservedFrame frame;
  double chi2 = 0;
  int dof = 0;
};

std::optional<OwnPose> EstimateOwnPose(const ObservedFrame& given,
                                       const std::vector<Eigen::Vector3d>& balls_in_body_mm) {
  OwnPose own;
  own.frame = given;
  own.frame.points.clear();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const auto equations = Compare(given, own.frame.world_from_body, balls_in_body_mm);
    if (!equations) return std::nullopt;
    const PoseStep step = Step(*equations);
    own.frame.pose_whitener = step.whitener;
    own.chi2 = equations->residual.squaredNorm() - step.length_sigma * step.length_sigma;
    own.dof = static_cast<int>(equations->residual.size() - step.whitener.rows());
    if (step.whitener.rows() < kFreeTurn) return std::nullopt;
    own.frame.world_from_body = Perturb(own.frame.world_from_body, step.delta);
    if (step.length_sigma < kConverged_sigma) break;
  }
  own.chi2 = std::max(own.chi2, 0.0);
  return own;
}

}  // namespace

CondensedFrames Condense(const std::vector<ObservedFrame>& frames,
                         const std::vector<Eigen::Vector3d>& balls_in_body_mm) {
  CondensedFrames condensed;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].points.empty()) {
      condensed.frames.push_back(frames[i]);
    } else {
      auto own = EstimateOwnPose(frames[i], balls_in_body_mm);
      if (!own) continue;
      condensed.chi2 += own->chi2;
      condensed.dof += own->dof;
      condensed.frames.push_back(std::move(own->frame));
    }
    condensed.kept.push_back(i);
  }
  return condensed;
}

}  // namespace stereomotion
