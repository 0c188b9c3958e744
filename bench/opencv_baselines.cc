#include "bench/opencv_baselines.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>

namespace stereomotion::bench {
namespace {

/// Size of a component against the ball's, both ways, that is still taken for it.
constexpr double kSmallest = 0.3;
constexpr double kLargest = 2;
/// Sobel's response to a step, in units of its height, at a blur of 0.67 px: 8 × the slope 0.6 / px
/// is shared by the kernel's three columns; σ = 1 px of smoothing halves it.
constexpr double kGradientSharp = 3;
constexpr double kGradientSmooth = 1.7;

/// Of the ball's height: 0.2, 0.3 and 0.5 were tried, with grey values counted from the threshold
/// and from the background. This one, from the threshold, gives the smallest errors at every light.
constexpr double kLowThreshold = 0.2;

double Gradient(const BallHints& hints) {
  return hints.amplitude_dn * (hints.smooth_px > 0 ? kGradientSmooth : kGradientSharp);
}

double DiscArea(const BallHints& hints) { return CV_PI / 4 * hints.diameter_px * hints.length_px; }

}  // namespace

void FindByMoments(const cv::Mat& grey, const BallHints& hints,
                   std::vector<Eigen::Vector2d>& centers_px) {
  const double level_dn = hints.background_dn + kLowThreshold * hints.amplitude_dn;
  cv::Mat bright = grey > level_dn;
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(bright, labels, stats, centroids);
  for (int label = 1; label < count; ++label) {
    const double area_px = stats.at<int>(label, cv::CC_STAT_AREA);
    if (area_px < kSmallest * DiscArea(hints) || area_px > kLargest * DiscArea(hints)) continue;
    const cv::Rect box(
        stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
        stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT));
    cv::Mat excess = cv::Mat::zeros(box.size(), CV_32F);
    cv::Mat grey_float;
    grey(box).convertTo(grey_float, CV_32F, 1, -level_dn);
    grey_float.copyTo(excess, labels(box) == label);
    const cv::Moments moments = cv::moments(excess);
    centers_px.emplace_back(box.x + moments.m10 / moments.m00, box.y + moments.m01 / moments.m00);
  }
}

void FindBySimpleBlobDetector(const cv::Mat& grey, const BallHints& hints,
                              std::vector<Eigen::Vector2d>& centers_px) {
  cv::SimpleBlobDetector::Params params;
  params.minThreshold = static_cast<float>(hints.background_dn + 0.3 * hints.amplitude_dn);
  params.maxThreshold = static_cast<float>(hints.background_dn + 0.8 * hints.amplitude_dn);
  params.thresholdStep = std::max(static_cast<float>(0.08 * hints.amplitude_dn), 1.0F);
  params.minRepeatability = 2;
  params.minDistBetweenBlobs = static_cast<float>(hints.diameter_px / 2);
  params.blobColor = 255;
  params.minArea = static_cast<float>(kSmallest * DiscArea(hints));
  params.maxArea = static_cast<float>(kLargest * DiscArea(hints));
  // Its other filters throw away smeared and partly hidden balls.
  params.filterByCircularity = params.filterByInertia = params.filterByConvexity = false;
  std::vector<cv::KeyPoint> points;
  cv::SimpleBlobDetector::create(params)->detect(grey, points);
  for (const cv::KeyPoint& point : points) centers_px.emplace_back(point.pt.x, point.pt.y);
}

void FindByCannyEllipse(const cv::Mat& grey, const BallHints& hints,
                        std::vector<Eigen::Vector2d>& centers_px) {
  constexpr std::size_t kFewestPoints = 6;  // an ellipse has five unknowns
  cv::Mat edges;
  cv::Canny(grey, edges, 0.25 * Gradient(hints), 0.5 * Gradient(hints), 3, true);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(edges, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  for (const auto& contour : contours) {
    if (contour.size() < kFewestPoints) continue;
    const cv::RotatedRect ellipse = cv::fitEllipse(contour);
    const double area_px = CV_PI / 4 * ellipse.size.width * ellipse.size.height;
    if (area_px < kSmallest * DiscArea(hints) || area_px > kLargest * DiscArea(hints)) continue;
    centers_px.emplace_back(ellipse.center.x, ellipse.center.y);
  }
}

void FindByHoughCircles(const cv::Mat& grey, const BallHints& hints,
                        std::vector<Eigen::Vector2d>& centers_px) {
  const double radius_px = hints.diameter_px / 2;
  // A quarter of the limb's pixels must vote for a centre.
  const double votes = std::max(2 * CV_PI * radius_px / 4, 4.0);
  std::vector<cv::Vec3f> circles;
  cv::HoughCircles(grey, circles, cv::HOUGH_GRADIENT, 1, hints.diameter_px,
                   std::max(0.5 * Gradient(hints), 1.0), votes, static_cast<int>(0.7 * radius_px),
                   static_cast<int>(1.3 * radius_px + 2));
  for (const cv::Vec3f& circle : circles) centers_px.emplace_back(circle[0], circle[1]);
}

}  // namespace stereomotion::bench
