#include "calibration/projected_line.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>

namespace stereomotion {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;

/// Solves A + B x − (k x) p = p, each row divided by the present 1 + k x: iterated, this is
/// least squares of distances (Sampson 1982).
Vector5d Solve(const std::vector<Eigen::Vector2d>& pixels_px, const std::vector<double>& share,
               double k) {
  const auto n = static_cast<Eigen::Index>(share.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * n, 5);
  Eigen::VectorXd right(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = share[static_cast<std::size_t>(i)];
    const Eigen::Vector2d& p = pixels_px[static_cast<std::size_t>(i)];
    const double w = 1 / (1 + k * x);
    rows.block<2, 2>(2 * i, 0).diagonal().setConstant(w);
    rows.block<2, 2>(2 * i, 2).diagonal().setConstant(w * x);
    rows.block<2, 1>(2 * i, 4) = -w * x * p;
    right.segment<2>(2 * i) = w * p;
  }
  return rows.colPivHouseholderQr().solve(right);
}

}  // namespace

double MisfitOfProjectedLine(const std::vector<Eigen::Vector2d>& pixels_px,
                             const std::vector<double>& share) {
  constexpr int kIterations = 4;
  Vector5d line = Vector5d::Zero();
  for (int i = 0; i < kIterations; ++i) {
    line = Solve(pixels_px, share, line[4]);
    if (!(line[4] > -1)) return std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Eigen::Vector2d p =
        (line.head<2>() + line.segment<2>(2) * share[i]) / (1 + line[4] * share[i]);
    sum += (pixels_px[i] - p).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(share.size()));
}

}  // namespace stereomotion
