#pragma once

#include <vector>

#include "detection/background_map.h"
#include "stereomotion/camera/rig.h"
#include "stereomotion/core/image.h"
#include "stereomotion/pipeline/learn_mask.h"

namespace stereomotion {

/// Keeps the highest background level of each cell over a camera's images: where something dark
/// passes, the lowest levels leave bright islands that are only background.
class HighestBackground {
 public:
  void Add(const ImageView& image, const SensorNoise& noise, double max_ball_px);
  /// By the cells of `BackgroundMap`.
  [[nodiscard]] const std::vector<float>& level_dn() const { return level_dn_; }

 private:
  BackgroundMap map_;
  std::vector<float> level_dn_;
};

/// Finds what rises over the background, as a whole search for balls would, in the lowest levels
/// of a camera's images, and over the background of all of them; whatever its shape is. What is
/// larger than a ball can be is left out: no search takes it for one (walls, the light ground
/// around something dark), and masked it would hide balls.
std::vector<StaticPlace> FindStaticPlaces(const Image& image, const HighestBackground& highest,
                                          const SensorNoise& noise, const RigCamera& camera,
                                          const DetectionOptions& detection, double margin_px);

using BallCenters = std::vector<Eigen::Vector2d>;  ///< of one image [px]

/// Counts the places in which a ball is in at least half of the images.
int CountBallPlaces(const std::vector<StaticPlace>& places, const std::vector<BallCenters>& images,
                    const RigCamera& camera);

/// Leaves of `all` the places whose middle no place of `masked` covers.
std::vector<StaticPlace> WithoutThose(std::vector<StaticPlace> all,
                                      const std::vector<StaticPlace>& masked,
                                      const RigCamera& camera);

}  // namespace stereomotion
