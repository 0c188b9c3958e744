#pragma once

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stereomotion::bench {

/// Says what a user of OpenCV would have tuned the functions for.
struct BallHints {
  double diameter_px = 9;
  double length_px = 9;  ///< the longest extent: diameter and smear
  double amplitude_dn = 100;
  double background_dn = 16;
  double smooth_px = 0;  ///< the image was smoothed by a Gaussian of this σ
};

/// Finds bright balls with common means, each with parameters from `hints` (docs/accuracy.md):
/// moments of the grey values above a threshold, counted from it, of every connected component;
void FindByMoments(const cv::Mat& grey, const BallHints& hints,
                   std::vector<Eigen::Vector2d>& centers_px);
/// cv::SimpleBlobDetector with seven thresholds;
void FindBySimpleBlobDetector(const cv::Mat& grey, const BallHints& hints,
                              std::vector<Eigen::Vector2d>& centers_px);
/// cv::Canny, cv::findContours, cv::fitEllipse;
void FindByCannyEllipse(const cv::Mat& grey, const BallHints& hints,
                        std::vector<Eigen::Vector2d>& centers_px);
/// cv::HoughCircles.
void FindByHoughCircles(const cv::Mat& grey, const BallHints& hints,
                        std::vector<Eigen::Vector2d>& centers_px);

}  // namespace stereomotion::bench
