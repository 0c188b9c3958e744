#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/accuracy_condition.h"
#include "stereomotion/core/image.h"

namespace stereomotion::bench {

/// Holds a ball's centre as a method found it; the covariance where the method states one.
struct FoundCenter {
  Eigen::Vector2d center_px;
  std::optional<Eigen::Matrix2d> covariance_px2;
};

/// Finds the balls of an image. One object a thread: it may keep memory.
class CenterMethod {
 public:
  CenterMethod() = default;
  virtual ~CenterMethod() = default;
  CenterMethod(const CenterMethod&) = delete;
  CenterMethod& operator=(const CenterMethod&) = delete;

  [[nodiscard]] virtual std::string name() const = 0;
  virtual void Find(const Image& image, std::vector<FoundCenter>& found) = 0;
};

/// Makes the three detectors and the four baselines, ready for balls of one condition. The
/// baselines are told the balls' size and how far the brightest pixel rises over the background
/// (`peak_dn`); the detectors know the noise only.
std::vector<std::unique_ptr<CenterMethod>> MakeMethods(const Condition& condition, double peak_dn);

}  // namespace stereomotion::bench
