#include "motion/common_errors.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace stereomotion {
namespace {

/// Finds a root of a covariance that may be singular (a body's is: its gauge has no error). Scaled
/// to correlations first, for its parameters differ in unit by many powers of ten.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& covariance) {
  constexpr double kNothing = 1e-12;  // of a correlation matrix's eigenvalue, whose mean is 1
  const Eigen::VectorXd u = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd weight = (u.array() > 0).select(u.cwiseInverse(), 0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weight.asDiagonal() * covariance *
                                                              weight.asDiagonal());
  Eigen::Index first = 0;  // eigenvalues ascend
  while (first < u.size() && solver.eigenvalues()[first] < kNothing) ++first;
  const Eigen::Index rank = u.size() - first;
  return u.asDiagonal() * solver.eigenvectors().rightCols(rank) *
         solver.eigenvalues().tail(rank).cwiseSqrt().asDiagonal();
}

Eigen::MatrixXd BlockDiagonal(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(a.rows() + b.rows(), a.cols() + b.cols());
  both.topLeftCorner(a.rows(), a.cols()) = a;
  both.bottomRightCorner(b.rows(), b.cols()) = b;
  return both;
}

/// Finds a parameter's place, which it gets in front of the balls' where it has none.
Eigen::Index PlaceOf(const RigParameter& parameter, CommonErrors& errors) {
  for (std::size_t k = 0; k < errors.parameters.size(); ++k) {
    const RigParameter& known = errors.parameters[k];
    if (known.camera == parameter.camera && known.index == parameter.index) {
      return static_cast<Eigen::Index>(k);
    }
  }
  const auto place = static_cast<Eigen::Index>(errors.parameters.size());
  Eigen::MatrixXd root = Eigen::MatrixXd::Zero(errors.Size() + 1, errors.root.cols());
  root.topRows(place) = errors.root.topRows(place);
  root.bottomRows(3 * errors.balls) = errors.root.bottomRows(3 * errors.balls);
  errors.root = root;
  errors.parameters.push_back(parameter);
  return place;
}

void Loosen(const RigParameter& parameter, double u, CommonErrors& errors) {
  const Eigen::Index place = PlaceOf(parameter, errors);
  errors.root.conservativeResize(Eigen::NoChange, errors.root.cols() + 1);
  errors.root.rightCols<1>().setZero();
  errors.root(place, errors.root.cols() - 1) = u;
}

}  // namespace

CommonErrors StatedErrors(const MotionData& data) {
  CommonErrors errors;
  errors.root.resize(0, 0);
  if (data.rig.covariance) {
    errors.parameters = data.rig.covariance->parameters;
    errors.root = RootOf(data.rig.covariance->matrix);
  }
  if (data.structure_covariance_mm2.size() > 0) {
    errors.balls = static_cast<int>(data.balls_in_body_mm.size());
    errors.root = BlockDiagonal(errors.root, RootOf(data.structure_covariance_mm2));
  }
  return errors;
}

CommonErrors LoosenRig(const MotionData& data, const CommonErrors& stated) {
  constexpr double kTurn_rad = 0.01;  // half a degree: 15 px
  constexpr double kShift_mm = 10;
  constexpr double kFocal = 0.01;  // of the focal length
  CommonErrors errors = stated;
  for (const int camera : {data.left_camera, data.right_camera}) {
    const CameraModel& model = data.rig.cameras[static_cast<std::size_t>(camera)].model;
    Loosen({camera, 0}, kFocal * model.fx_px, errors);
    Loosen({camera, 1}, kFocal * model.fy_px, errors);
  }
  for (int axis = 0; axis < 3; ++axis) {
    Loosen({data.right_camera, 9 + axis}, kTurn_rad, errors);
    Loosen({data.right_camera, 12 + axis}, kShift_mm, errors);
  }
  return errors;
}

}  // namespace stereomotion
