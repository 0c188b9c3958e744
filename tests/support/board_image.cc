#include "tests/support/board_image.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace stereomotion::testing {
namespace {

constexpr int kCells =
    4;                    ///< light cells a pixel and axis: a quarter of a pixel, fine for the blur
constexpr int kFine = 8;  ///< samples a cell and axis where an edge is near

Eigen::AlignedBox2d BoundingBox(const std::vector<PrintShape>& shapes) {
  Eigen::AlignedBox2d box;
  for (const PrintShape& shape : shapes) {
    const Eigen::Vector2d size(shape.width_mm, shape.height_mm);
    const Eigen::Vector2d corner =
        Eigen::Vector2d(shape.x_mm, shape.y_mm) - (shape.circle ? 0.5 : 0.0) * size;
    box.extend(corner).extend(corner + size);
  }
  return box;
}

bool Covers(const PrintShape& shape, const Eigen::Vector2d& at_mm) {
  const double x = at_mm.x() - shape.x_mm, y = at_mm.y() - shape.y_mm;
  if (shape.circle) return 4 * (x * x + y * y) < shape.width_mm * shape.width_mm;
  return x >= 0 && y >= 0 && x < shape.width_mm && y < shape.height_mm;
}

/// Finds the light of a place on the board: 0 the background, 1 black, 2 white.
class Paper {
 public:
  Paper(const std::vector<PrintShape>& shapes, double margin_mm)
      : shapes_(shapes), box_(BoundingBox(shapes)) {
    const Eigen::Vector2d margin(margin_mm, margin_mm);
    box_ = Eigen::AlignedBox2d(box_.min() - margin, box_.max() + margin);
    for (int i = 0; i < static_cast<int>(shapes.size()); ++i) {
      const Eigen::AlignedBox2d reach = BoundingBox({shapes[i]});
      const auto low = Bucket(reach.min()), high = Bucket(reach.max());
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) buckets_[y * kBuckets + x].push_back(i);
      }
    }
  }

  [[nodiscard]] int At(const Eigen::Vector2d& at_mm) const {
    if (!box_.contains(at_mm)) return 0;
    const auto bucket = Bucket(at_mm);
    int light = 2;
    for (const int i : buckets_[bucket[1] * kBuckets + bucket[0]]) {
      if (Covers(shapes_[i], at_mm)) light = shapes_[i].black ? 1 : 2;
    }
    return light;
  }

 private:
  static constexpr int kBuckets = 64;
  [[nodiscard]] std::array<int, 2> Bucket(const Eigen::Vector2d& at_mm) const {
    const Eigen::Vector2d place = (at_mm - box_.min()).cwiseQuotient(box_.sizes()) * kBuckets;
    return {std::clamp(static_cast<int>(place.x()), 0, kBuckets - 1),
            std::clamp(static_cast<int>(place.y()), 0, kBuckets - 1)};
  }

  std::vector<PrintShape> shapes_;
  Eigen::AlignedBox2d box_;
  std::array<std::vector<int>, kBuckets * kBuckets> buckets_;
};

/// Board coordinates at the pixels' corners; within a pixel they are bilinear to 1e-5 px.
class BoardMap {
 public:
  BoardMap(const CameraModel& camera, const Rigid3& cam_from_board, int width_px, int height_px)
      : width_(width_px + 1) {
    const Rigid3 board_from_cam = cam_from_board.Inverse();
    for (int v = 0; v <= height_px; ++v) {
      for (int u = 0; u <= width_px; ++u) {
        const auto ray = camera.Unproject({u - 0.5, v - 0.5});
        const Eigen::Vector3d direction =
            board_from_cam.rotation * (ray ? ray->homogeneous() : Eigen::Vector3d(1e6, 0, 1));
        const Eigen::Vector3d start = board_from_cam.translation_mm;
        corners_mm_.emplace_back((start - start.z() / direction.z() * direction).head<2>());
      }
    }
  }

  /// `u`, `v` in pixels from the image's top-left corner.
  [[nodiscard]] Eigen::Vector2d At(double u, double v) const {
    const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
    const double a = u - u0, b = v - v0;
    const auto corner = [&](int du, int dv) -> const Eigen::Vector2d& {
      return corners_mm_[static_cast<std::size_t>((v0 + dv) * width_ + u0 + du)];
    };
    if (a == 0 && b == 0) return corner(0, 0);
    const int next_u = a > 0 ? 1 : 0, next_v = b > 0 ? 1 : 0;
    return (1 - b) * ((1 - a) * corner(0, 0) + a * corner(next_u, 0)) +
           b * ((1 - a) * corner(0, next_v) + a * corner(next_u, next_v));
  }

 private:
  int width_;
  std::vector<Eigen::Vector2d> corners_mm_;
};

/// Grey value of a light cell: the mean of 8 × 8 samples.
float MeanOfCell(const Paper& paper, const BoardMap& map, const float* greys, int x, int y) {
  float sum = 0;
  for (int j = 0; j < kFine; ++j) {
    for (int i = 0; i < kFine; ++i) {
      sum += greys[paper.At(
          map.At((x + (i + 0.5) / kFine) / kCells, (y + (j + 0.5) / kFine) / kCells))];
    }
  }
  return sum / (kFine * kFine);
}

cv::Mat RenderCells(const Paper& paper, const BoardMap& map, const BoardImageOptions& options) {
  float greys[] = {static_cast<float>(options.background_dn), static_cast<float>(options.black_dn),
                   static_cast<float>(options.white_dn)};
  if (options.inverted) std::swap(greys[1], greys[2]);
  const int width = options.width_px * kCells, height = options.height_px * kCells;
  cv::Mat corners(height + 1, width + 1, CV_8U);
  for (int y = 0; y <= height; ++y) {
    for (int x = 0; x <= width; ++x) {
      corners.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(
          paper.At(map.At(static_cast<double>(x) / kCells, static_cast<double>(y) / kCells)));
    }
  }
  cv::Mat highest, lowest;  // of each cell's corners and its neighbours'
  cv::dilate(corners, highest, cv::Mat::ones(4, 4, CV_8U), {1, 1});
  cv::erode(corners, lowest, cv::Mat::ones(4, 4, CV_8U), {1, 1});
  cv::Mat cells(height, width, CV_32F);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int light = corners.at<std::uint8_t>(y, x);
      cells.at<float>(y, x) = highest.at<std::uint8_t>(y, x) == lowest.at<std::uint8_t>(y, x)
                                  ? greys[light]
                                  : MeanOfCell(paper, map, greys, x, y);
    }
  }
  return cells;
}

cv::Mat BlurToPixels(cv::Mat cells, const BoardImageOptions& options) {
  if (options.blur_px > 0) cv::GaussianBlur(cells, cells, {}, options.blur_px * kCells);
  cv::Mat mean_dn;
  cv::resize(cells, mean_dn, {options.width_px, options.height_px}, 0, 0, cv::INTER_AREA);
  return mean_dn;
}

Image Expose(const cv::Mat& mean_dn, const BoardImageOptions& options) {
  std::mt19937_64 rng(options.seed);
  std::normal_distribution<double> normal;
  Image image;
  image.Resize(options.width_px, options.height_px, PixelType::kGray8);
  for (int v = 0; v < options.height_px; ++v) {
    for (int u = 0; u < options.width_px; ++u) {
      const double light = 1 + options.light_slope * (u / (options.width_px - 1.0) - 0.5);
      double grey_dn = mean_dn.at<float>(v, u) * light;
      if (options.noise) {
        // The rounding below adds its 1/12 by itself.
        grey_dn += std::sqrt(options.noise->VarianceDn2(grey_dn) - 1.0 / 12) * normal(rng);
      }
      image.Row<std::uint8_t>(v)[u] =
          static_cast<std::uint8_t>(std::lround(std::clamp(grey_dn, 0.0, 255.0)));
    }
  }
  return image;
}

}  // namespace

Image RenderShapes(const std::vector<PrintShape>& shapes, const CameraModel& camera,
                   const Rigid3& cam_from_board, const BoardImageOptions& options) {
  const Paper paper(shapes, options.paper_margin_mm);
  const BoardMap map(camera, cam_from_board, options.width_px, options.height_px);
  return Expose(BlurToPixels(RenderCells(paper, map, options), options), options);
}

Image RenderBoard(const Target& target, const CameraModel& camera, const Rigid3& cam_from_board,
                  const BoardImageOptions& options) {
  return RenderShapes(TargetShapes(target), camera, cam_from_board, options);
}

}  // namespace stereomotion::testing
