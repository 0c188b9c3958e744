#include "motion/reduce_frames.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>

#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

Eigen::MatrixXd Triangular(const Eigen::MatrixXd& rows) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const Eigen::Index kept = std::min(rows.rows(), rows.cols());
  return qr.matrixQR().topRows(kept).triangularView<Eigen::Upper>();
}

}  // namespace

Eigen::MatrixXd EliminateLocal(const CenterEquations& equations) {
  const Eigen::Index globals = equations.d_global.cols();
  // Pivoted: a turn that the frame does not tell (a line of balls with the centre on it) must not
  // swallow a row of the others.
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(equations.d_local);
  Eigen::MatrixXd rest(equations.residual.size(), globals + 1);
  rest << equations.d_global, equations.residual;
  rest.applyOnTheLeft(qr.householderQ().adjoint());
  const Eigen::Index left = rest.rows() - qr.rank();
  if (left <= globals + 1) return rest.bottomRows(left);
  return Triangular(rest.bottomRows(left));
}

void RowStack::Add(const Eigen::MatrixXd& rows) {
  // Triangularised when the stack is four times as high as wide: linear cost, little overhead.
  constexpr Eigen::Index kHeight = 4;
  Eigen::MatrixXd stacked(rows_.rows() + rows.rows(), rows_.cols());
  stacked << rows_, rows;
  rows_ = stacked.rows() > kHeight * stacked.cols() ? Triangular(stacked) : std::move(stacked);
}

Eigen::MatrixXd RowStack::Triangle() const {
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(rows_.cols(), rows_.cols());
  if (rows_.rows() == 0) return square;
  const Eigen::MatrixXd triangle = Triangular(rows_);
  square.topRows(triangle.rows()) = triangle;
  return square;
}

FrameCurvature CurvatureOf(const CenterModel& model, const ObservedFrame& frame,
                           const Eigen::VectorXd& local, const Eigen::VectorXd& globals) {
  FrameCurvature curvature{Eigen::Matrix3d::Zero(), Eigen::MatrixXd::Zero(3, model.GlobalSize())};
  const Rigid3 pose = PoseOf(model, frame, local, globals);
  const std::vector<Eigen::Vector3d> balls = Balls(model, globals);
  const auto equations = Compare(frame, pose, balls);
  if (!equations) return curvature;
  const Eigen::Matrix3d rotation = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d center_mm = CenterInBody(model, globals);
  // A point at Exp(δθ) R (b − c) + p whose gradient is g: second derivatives of g · point.
  for (Eigen::Index row = 0; row < equations->residual.size(); ++row) {
    const int ball = equations->balls[static_cast<std::size_t>(row)];
    const Eigen::Vector3d place_mm =
        ball < 0 ? Eigen::Vector3d(-center_mm) : balls[static_cast<std::size_t>(ball)] - center_mm;
    const Eigen::Vector3d arm_mm = rotation * place_mm;
    const Eigen::Vector3d gradient =
        equations->residual[row] * equations->d_pose.row(row).tail<3>().transpose();
    const Eigen::Matrix3d product = gradient * arm_mm.transpose();
    curvature.local += 0.5 * (product + product.transpose());
    curvature.local.diagonal().array() -= gradient.dot(arm_mm);
    const Eigen::Matrix3d turned = Hat(gradient) * rotation;
    curvature.mixed.leftCols(model.CenterSize()) += turned * model.basis;
    if (ball < 0 || model.gauge.cols() == 0) continue;
    curvature.mixed.rightCols(model.gauge.cols()) -= turned * model.gauge.middleRows<3>(3 * ball);
  }
  return curvature;
}

}  // namespace stereomotion
