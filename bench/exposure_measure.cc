#include "bench/exposure_measure.h"

#include <array>
#include <cmath>
#include <optional>
#include <random>

#include "stereomotion/detection/detect_balls.h"
#include "stereomotion/pose/acquire_pose.h"
#include "stereomotion/simulation/render_scene.h"
#include "stereomotion/stereo/match_balls.h"

namespace stereomotion::bench {
namespace {

constexpr double kTranslation_mm = 20;
constexpr int kNoisesPerPlace = 50;  // at each, two cameras see ten balls at their own phases

/// Both cameras' mean images at one position.
using MeanPair = std::array<MeanImage, 2>;

class PairMeasurer {
 public:
  explicit PairMeasurer(const Scenario& scene) : scene_(scene), detector_(scene.sensor.noise()) {}

  /// Exposes and measures a pair; stream pairs must not repeat.
  std::optional<PoseFix> Measure(const MeanPair& mean_dn, std::uint64_t stream) {
    for (std::size_t camera = 0; camera < 2; ++camera) {
      SensorOptions options;
      options.noise = scene_.sensor.noise();
      options.bits = scene_.sensor.bits;
      options.seed = scene_.seed;
      options.stream = 2 * stream + camera;
      Expose(mean_dn[camera], options, image_);
      detector_.Detect(image_.View(), balls_[camera]);
    }
    const auto fix = AcquirePose(scene_.rig.cameras[0], scene_.rig.cameras[1], scene_.body,
                                 balls_[0], balls_[1]);
    return fix ? std::optional<PoseFix>(*fix) : std::nullopt;
  }

  /// Compares the balls of the last pair, as the two images alone give them, with the truth.
  void AddDeviations(const PoseFix& fix, const Rigid3& true_world_from_body,
                     std::vector<BallDeviation>& deviations) {
    FindStereoCandidates(scene_.rig.cameras[0], scene_.rig.cameras[1], balls_[0], balls_[1],
                         scene_.body.rods.front().ball_diameter_mm / 2, {}, candidates_);
    for (const StereoCandidate& candidate : candidates_) {
      const BallId* left = IdOf(fix, 0, candidate.left);
      const BallId* right = IdOf(fix, 1, candidate.right);
      if (left == nullptr || right == nullptr || !(*left == *right)) continue;
      const Eigen::Vector3d& p_in_body_mm =
          scene_.body.rods[static_cast<std::size_t>(left->rod)]
              .balls_in_body_mm[static_cast<std::size_t>(left->ball)];
      deviations.push_back(
          {*left, (candidate.point.p_in_world_mm - true_world_from_body * p_in_body_mm).norm()});
    }
  }

 private:
  static const BallId* IdOf(const PoseFix& fix, int camera, int detection) {
    for (const BallAssignment& used : fix.used) {
      if (used.camera == camera && used.detection == detection) return &used.id;
    }
    return nullptr;
  }

  const Scenario& scene_;
  BallDetector detector_;
  Image image_;
  std::array<std::vector<BallObservation>, 2> balls_;
  std::vector<StereoCandidate> candidates_;
};

TranslationSample Compare(const PoseFix& first, const PoseFix& second) {
  const Eigen::Vector3d direction = MotionDirection();
  const Eigen::Vector3d moved_mm =
      second.pose.world_from_body.translation_mm - first.pose.world_from_body.translation_mm;
  const Eigen::Vector3d error_mm = moved_mm - kTranslation_mm * direction;
  const Eigen::Matrix3d covariance_mm2 =
      (first.pose.covariance + second.pose.covariance).bottomRightCorner<3, 3>();
  return {direction.dot(error_mm), error_mm.norm(),
          std::sqrt(direction.dot(covariance_mm2 * direction))};
}

/// Puts the body to a place within the pixels: anywhere in ± 1 px.
Eigen::Vector3d DrawPlace_mm(std::mt19937_64& rng) {
  std::uniform_real_distribution<double> within_mm(-1.5, 1.5);
  const double x_mm = within_mm(rng);
  const double y_mm = within_mm(rng);
  return {x_mm, y_mm, 0};
}

MeanPair RenderPair(const Scenario& scene, double time_s) {
  MeanPair mean_dn;
  for (int camera = 0; camera < 2; ++camera) {
    RenderSceneMean(scene, camera, time_s, mean_dn[static_cast<std::size_t>(camera)]);
  }
  return mean_dn;
}

}  // namespace

ExposureSamples MeasureTranslations(const ExposureCondition& condition, int repetitions,
                                    std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  Scenario scene = MakeExposureScene(condition);
  scene.seed = seed;
  const double between_s = kTranslation_mm / condition.speed_mm_s;
  ExposureSamples samples;
  for (int done = 0; done < repetitions; done += kNoisesPerPlace) {
    scene.motion.center_in_world_mm = DrawPlace_mm(rng);
    const MeanPair first_dn = RenderPair(scene, -between_s / 2);
    const MeanPair second_dn = RenderPair(scene, between_s / 2);
    PairMeasurer measurer(scene);
    for (int i = done; i < done + kNoisesPerPlace; ++i) {
      const auto stream = static_cast<std::uint64_t>(2 * i);
      const auto first = measurer.Measure(first_dn, stream);
      const auto second = measurer.Measure(second_dn, stream + 1);
      if (!first || !second) {
        ++samples.lost;
        continue;
      }
      samples.translations.push_back(Compare(*first, *second));
      measurer.AddDeviations(*second, StateAt(scene.motion, between_s / 2).world_from_body,
                             samples.balls);
    }
  }
  return samples;
}

}  // namespace stereomotion::bench
