#include "motion/free_path.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <limits>
#include <utility>

#include "motion/path_chain.h"
#include "motion/reduce_frames.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

constexpr Eigen::Index kState = 6;
constexpr int kMaxIterations = 50;
/// The centre moves by less than this part of its uncertainty: done.
constexpr double kConverged = 1e-6;

/// Everything that the iteration moves.
struct FreePath {
  CenterModel model;  ///< its path is one position: that of the frame in question
  Eigen::VectorXd y;
  std::vector<Eigen::VectorXd> states;      ///< of every frame of the data: position, velocity
  std::vector<const ObservedFrame*> poses;  ///< nothing at gaps
  std::vector<Eigen::Vector3d> locals;
  std::vector<double> times_s;
};

FreePath StartOf(const CenterProblem& problem) {
  FreePath path;
  path.model = ModelOf(problem, 1, true);
  path.y = Eigen::VectorXd::Zero(path.model.CenterSize());
  const auto& frames = problem.data->frames;
  path.poses.assign(frames.size(), nullptr);
  for (const ObservedFrame& pose : problem.poses) path.poses[pose.index] = &pose;
  path.locals.assign(frames.size(), Eigen::Vector3d::Zero());
  Eigen::VectorXd state = Eigen::VectorXd::Zero(kState);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    path.times_s.push_back(
        SecondsBetween(frames.front().pose.timestamp_ns, frames[i].pose.timestamp_ns));
    if (path.poses[i] != nullptr) {
      state.head<3>() = path.poses[i]->world_from_body * problem.origin_in_body_mm;
    }
    path.states.push_back(state);
  }
  return path;
}

CenterEquations EquationsAt(const FreePath& path, std::size_t i) {
  Eigen::VectorXd globals(path.y.size() + 3);
  globals << path.y, path.states[i].head<3>();
  return *Linearize(path.model, *path.poses[i], path.locals[i], globals);  // poses always compare
}

/// Rows [x_t y | z] of a pose, its rotation eliminated.
Eigen::MatrixXd OwnRows(const FreePath& path, std::size_t i) {
  const Eigen::Index shared = path.y.size();
  if (path.poses[i] == nullptr) return Eigen::MatrixXd(0, kState + shared + 1);
  const Eigen::MatrixXd free = EliminateLocal(EquationsAt(path, i));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(free.rows(), kState + shared + 1);
  rows.leftCols<3>() = free.middleCols<3>(shared);
  rows.middleCols(kState, shared) = free.leftCols(shared);
  rows.rightCols<1>() = free.rightCols<1>();
  return rows;
}

/// Rows [x_t x_{t+1} y | z] of the process: Φ x_t − x_{t+1} is white with covariance Q.
Eigen::MatrixXd TransitionRows(const FreePath& path, std::size_t i, double psd_mm2_s3) {
  const double dt = path.times_s[i + 1] - path.times_s[i];
  Eigen::Matrix2d q;
  q << dt * dt * dt / 3, dt * dt / 2, dt * dt / 2, dt;
  const Eigen::Matrix2d root = (psd_mm2_s3 * q).llt().matrixL().solve(Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d forward = root * (Eigen::Matrix2d() << 1, dt, 0, 1).finished();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kState, 2 * kState + path.y.size() + 1);
  for (Eigen::Index a = 0; a < 2; ++a) {
    for (Eigen::Index b = 0; b < 2; ++b) {
      rows.block<3, 3>(3 * a, 3 * b) = forward(a, b) * Eigen::Matrix3d::Identity();
      rows.block<3, 3>(3 * a, kState + 3 * b) = -root(a, b) * Eigen::Matrix3d::Identity();
    }
  }
  rows.rightCols<1>() = rows.leftCols<kState>() * path.states[i] +
                        rows.middleCols<kState>(kState) * path.states[i + 1];
  return rows;
}

PathChain ChainOf(const FreePath& path, double psd_mm2_s3) {
  PathChain chain;
  chain.shared = path.y.size();
  for (std::size_t i = 0; i < path.states.size(); ++i) {
    chain.own.push_back(OwnRows(path, i));
    if (i + 1 < path.states.size()) {
      chain.transition.push_back(TransitionRows(path, i, psd_mm2_s3));
    }
  }
  return chain;
}

/// Moves a frame's rotation to where it fits best after the step of everything else.
void Move(FreePath& path, const std::vector<ChainState>& solved) {
  const Eigen::Index shared = path.y.size();
  const Eigen::VectorXd y_step = solved.front().step.tail(shared);
  for (std::size_t i = 0; i < path.states.size(); ++i) {
    const Eigen::VectorXd step = solved[i].step.head<kState>();
    if (path.poses[i] != nullptr) {
      const CenterEquations equations = EquationsAt(path, i);
      Eigen::VectorXd global(shared + 3);
      global << y_step, step.head<3>();
      const Eigen::Vector3d turn = -equations.d_local.colPivHouseholderQr().solve(
          equations.residual + equations.d_global * global);
      path.locals[i] = LogSO3(ExpSO3(turn) * ExpSO3(path.locals[i]));
    }
  }
  for (std::size_t i = 0; i < path.states.size(); ++i) {
    path.states[i] += solved[i].step.head<kState>();
  }
  path.y += y_step;
}

CenterState StateOf(const Eigen::VectorXd& state, const Eigen::MatrixXd& covariance) {
  CenterState result;
  result.position_mm = state.head<3>();
  result.velocity_mm_s = state.tail<3>();
  result.covariance.topLeftCorner<6, 6>() = covariance.topLeftCorner<6, 6>();
  result.covariance.diagonal().tail<3>().setConstant(std::numeric_limits<double>::infinity());
  return result;
}

SpinCenter CenterOf(const CenterProblem& problem, const FreePath& path,
                    const std::vector<ChainState>& solved) {
  SpinCenter center;
  center.law = PathLaw::kFree;
  const Eigen::Index shared = path.y.size();
  center.in_body_mm = CenterInBody(path.model, path.y);
  center.covariance_mm2 = path.model.basis *
                          solved.front().covariance.bottomRightCorner(shared, shared) *
                          path.model.basis.transpose();
  center.free_axis_in_body = problem.free_axis_in_body;
  for (std::size_t i = 0; i < path.states.size(); ++i) {
    center.states.push_back(StateOf(path.states[i], solved[i].covariance));
    Rigid3 pose = problem.data->frames[i].pose.world_from_body;
    if (path.poses[i] != nullptr) {
      Eigen::VectorXd globals(shared + 3);
      globals << path.y, path.states[i].head<3>();
      pose = PoseOf(path.model, *path.poses[i], path.locals[i], globals);
    }
    center.poses.push_back(pose);
  }
  return center;
}

}  // namespace

std::optional<SpinCenter> FindOnFreePath(const CenterProblem& problem, double psd_mm2_s3) {
  if (problem.poses.size() < 3 || problem.basis.cols() == 0) return std::nullopt;
  FreePath path = StartOf(problem);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const auto solved = SolveChain(ChainOf(path, psd_mm2_s3));
    if (!solved) return std::nullopt;
    const Eigen::VectorXd step = solved->front().step.tail(path.y.size());
    const Eigen::VectorXd sigma =
        solved->front().covariance.diagonal().tail(path.y.size()).cwiseSqrt();
    Move(path, *solved);
    if ((step.cwiseAbs().array() > kConverged * sigma.array()).any()) continue;
    return CenterOf(problem, path, *solved);
  }
  return std::nullopt;
}

}  // namespace stereomotion
