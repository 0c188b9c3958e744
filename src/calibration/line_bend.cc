#include "line_bend.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

namespace stereomotion {
namespace {

/// Two and a half points for each coefficient and coordinate.
constexpr std::size_t kMinPoints = 24;
/// Where the normalised normal matrix is flatter than this the points do not span the terms.
constexpr double kRankThreshold = 1e-3;

Eigen::Matrix<double, 1, 10> Terms(double x, double y) {
  Eigen::Matrix<double, 1, 10> terms;
  terms << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

std::vector<Eigen::Vector2d> MapByHomography(const std::vector<Eigen::Vector2d>& board_mm,
                                             const std::vector<Eigen::Vector2d>& pixels_px) {
  std::vector<cv::Point2d> from, to, mapped;
  for (std::size_t i = 0; i < board_mm.size(); ++i) {
    from.emplace_back(board_mm[i].x(), board_mm[i].y());
    to.emplace_back(pixels_px[i].x(), pixels_px[i].y());
  }
  const cv::Mat image_from_board = cv::findHomography(from, to);
  if (image_from_board.empty()) return {};
  cv::perspectiveTransform(from, mapped, image_from_board);
  std::vector<Eigen::Vector2d> result;
  for (const cv::Point2d& point : mapped) result.emplace_back(point.x, point.y);
  return result;
}

}  // namespace

LineBend::LineBend(const std::vector<Eigen::Vector2d>& board_mm,
                   const std::vector<Eigen::Vector2d>& pixels_px) {
  if (board_mm.size() < kMinPoints) return;
  const auto ideal_px = MapByHomography(board_mm, pixels_px);
  if (ideal_px.empty()) return;
  const auto count = static_cast<Eigen::Index>(ideal_px.size());
  for (const auto& point : ideal_px) center_px_ += point / static_cast<double>(count);
  for (const auto& point : ideal_px) {
    scale_px_ = std::max(scale_px_, (point - center_px_).cwiseAbs().maxCoeff());
  }
  Eigen::MatrixXd design(count, kNumTerms);
  Eigen::MatrixXd rest_px(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector2d at = (ideal_px[i] - center_px_) / scale_px_;
    design.row(i) = Terms(at.x(), at.y());
    rest_px.row(i) = (pixels_px[i] - ideal_px[i]).transpose();
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kRankThreshold);
  terms_ = solver.compute(design).solve(rest_px);
}

Eigen::Vector2d LineBend::Curvature(const Eigen::Vector2d& pixel_px,
                                    const Eigen::Vector2d& direction) const {
  const Eigen::Vector2d at = (pixel_px - center_px_) / scale_px_;
  const Eigen::Vector2d d = direction.normalized();
  const auto term = [&](int i) -> Eigen::Vector2d { return terms_.row(i).transpose(); };
  const Eigen::Vector2d xx = 2 * term(3) + 6 * at.x() * term(6) + 2 * at.y() * term(7);
  const Eigen::Vector2d xy = term(4) + 2 * at.x() * term(7) + 2 * at.y() * term(8);
  const Eigen::Vector2d yy = 2 * term(5) + 2 * at.x() * term(8) + 6 * at.y() * term(9);
  const Eigen::Vector2d second = d.x() * d.x() * xx + 2 * d.x() * d.y() * xy + d.y() * d.y() * yy;
  return second / (scale_px_ * scale_px_);
}

}  // namespace stereomotion
