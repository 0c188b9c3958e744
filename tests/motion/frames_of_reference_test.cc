#include "stereomotion/motion/frames_of_reference.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cctype>
#include <cmath>

#include "stereomotion/geometry/so3.h"
#include "tests/support/statistics.h"
#include "tests/support/test_rng.h"

namespace stereomotion::testing {
namespace {

constexpr double kPi = 3.14159265358979323846;

PoseSample SampleAt(const Eigen::Quaterniond& rotation, int frame = 0) {
  PoseSample sample;
  sample.frame = frame;
  sample.timestamp_ns = frame * 10'000'000LL;
  sample.measured = true;
  sample.world_from_body.rotation = rotation;
  sample.covariance = 1e-8 * Matrix6d::Identity();
  return sample;
}

/// Multiplies the three rotations of a sequence out, by its definition.
Eigen::Quaterniond Compose(const std::string& axes, const Eigen::Vector3d& angles_rad) {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = std::tolower(axes[i]) - 'x';
    const Eigen::Quaterniond step(
        Eigen::AngleAxisd(angles_rad[static_cast<int>(i)], Eigen::Vector3d::Unit(axis)));
    rotation = std::isupper(axes[i]) != 0 ? step * rotation : rotation * step;
  }
  return rotation;
}

struct ScipyAngles {
  const char* axes;
  double angles_rad[3];
};

// scipy 1.17.1: Rotation.from_quat([-0.2, 0.5, 0.3, 0.7]).as_euler(axes), scipy's upper case being
// intrinsic, ours extrinsic.
constexpr ScipyAngles kScipy[] = {
    {"xyz", {-1.10714871779409, 0.729727656226967, 1.27343118157097}},
    {"XYZ", {0.0688564893010445, 1.23011949707199, 0.858438728700568}},
    {"xzy", {0.0327751444040757, 0.793259499306366, 1.25422707318249}},
    {"XZY", {-0.760193418070507, 0.255649200798277, 1.34310700702624}},
    {"yxz", {1.10714871779409, -0.729727656226966, 0.346135963569361}},
    {"YXZ", {1.23086595732528, 0.0229905310234213, 0.793528065577392}},
    {"yzx", {1.34310700702624, 0.255649200798277, -0.760193418070507}},
    {"YZX", {1.25422707318249, 0.793259499306366, 0.0327751444040757}},
    {"zxy", {0.793528065577392, 0.0229905310234213, 1.23086595732528}},
    {"ZXY", {0.346135963569361, -0.729727656226966, 1.10714871779409}},
    {"zyx", {0.858438728700568, 1.23011949707199, 0.0688564893010445}},
    {"ZYX", {1.27343118157097, 0.729727656226967, -1.10714871779409}},
    {"xyx", {0.262119841265473, 1.35063116139326, -0.818719159275695}},
    {"XYX", {-0.818719159275695, 1.35063116139326, 0.262119841265473}},
    {"xzx", {-1.30867648552942, 1.35063116139326, 0.752077167519201}},
    {"XZX", {0.752077167519201, 1.35063116139326, -1.30867648552942}},
    {"yxy", {-1.53854944435964, 0.793788040520296, 2.77904841632529}},
    {"YXY", {2.77904841632529, 0.793788040520296, -1.53854944435964}},
    {"yzy", {0.0322468824352539, 0.793788040520296, 1.20825208953039}},
    {"YZY", {1.20825208953039, 0.793788040520296, 0.0322468824352539}},
    {"zxz", {2.35619449019234, 1.23095941734077, -1.54641091762218}},
    {"ZXZ", {-1.54641091762218, 1.23095941734077, 2.35619449019234}},
    {"zyz", {0.785398163397448, 1.23095941734077, 0.0243854091727185}},
    {"ZYZ", {0.0243854091727185, 1.23095941734077, 0.785398163397448}},
};

TEST(AnglesOf, AgreesWithScipyInAllSequences) {
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.7, -0.2, 0.5, 0.3).normalized();
  for (const ScipyAngles& expected : kScipy) {
    const PoseAngles found = AnglesOf({SampleAt(rotation)}, {expected.axes})[0];
    ASSERT_TRUE(found.measured && !found.locked);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(found.angles_rad[i], expected.angles_rad[i], 1e-13) << expected.axes;
    }
    EXPECT_LT(Compose(expected.axes, found.angles_rad).angularDistance(rotation), 1e-14);
  }
}

TEST(AnglesOf, CovarianceGoesThroughTheJacobian) {
  std::mt19937_64 rng = MakeTestRng();
  for (const ScipyAngles& sequence : kScipy) {
    const Eigen::Vector3d angles(Uniform(rng, -3, 3), Uniform(rng, 0.3, 1.2), Uniform(rng, -3, 3));
    PoseSample sample = SampleAt(Compose(sequence.axes, angles));
    const Eigen::Matrix3d root = 1e-4 * Eigen::Matrix3d::Random();
    sample.covariance.topLeftCorner<3, 3>() = root * root.transpose();
    const PoseAngles found = AnglesOf({sample}, {sequence.axes})[0];
    Eigen::Matrix3d jacobian;
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-5;
      const auto at = [&](double step) {
        PoseSample moved = sample;
        moved.world_from_body = Perturb(moved.world_from_body, step * Vector6d::Unit(k));
        return AnglesOf({sample, moved}, {sequence.axes})[1].angles_rad;
      };
      jacobian.col(k) = (at(h) - at(-h)) / (2 * h);
    }
    const Eigen::Matrix3d expected = jacobian * root * root.transpose() * jacobian.transpose();
    EXPECT_LT((found.covariance_rad2 - expected).norm(), 1e-8 * expected.norm()) << sequence.axes;
  }
}

TEST(AnglesOf, AnglesAreContinuousOverTurnsAndBeyondTheLock) {
  for (const char* axes : {"zxy", "XYZ", "zxz", "YXY"}) {
    PoseSeries series;
    const auto angles_at = [](int i) {
      const double t = 0.037 * i;  // steps over the lock itself
      return Eigen::Vector3d(3 * t, 0.2 + 0.7 * t, -2 * t);
    };
    for (int i = 0; i < 200; ++i) series.push_back(SampleAt(Compose(axes, angles_at(i)), i));
    const std::vector<PoseAngles> found = AnglesOf(series, {axes});
    for (int i = 0; i < 200; ++i) {
      const PoseAngles& angles = found[static_cast<std::size_t>(i)];
      ASSERT_FALSE(angles.locked);
      EXPECT_LT((angles.angles_rad - angles_at(i)).norm(), 1e-9) << axes << i;
    }
  }
}

TEST(AnglesOf, LockIsDeclaredByTheUncertainty) {
  for (const auto& [axes, lock] : {std::pair("zxy", kPi / 2), std::pair("zxz", 0.0)}) {
    // 0.1 mrad: three of them before the lock nothing is known of the other two angles.
    for (const auto& [off, locked] : {std::pair(2e-4, true), std::pair(4.5e-4, false)}) {
      const Eigen::Vector3d angles(0.3, axes[2] == 'z' ? lock + off : lock - off, 0.4);
      const PoseAngles found = AnglesOf({SampleAt(Compose(axes, angles))}, {axes})[0];
      EXPECT_TRUE(found.measured);
      EXPECT_EQ(found.locked, locked) << axes << off;
      EXPECT_NEAR(found.angles_rad[1], angles[1], 1e-10);
      EXPECT_NEAR(found.covariance_rad2(1, 1), 1e-8, 1e-15);
    }
  }
}

TEST(AnglesOf, GapsAndFreeAxesHaveNoAngles) {
  PoseSample gap;
  PoseSample rod = SampleAt(Eigen::Quaterniond::Identity());
  rod.free_axis_in_world = Eigen::Vector3d::UnitX();
  for (const PoseAngles& angles : AnglesOf({gap, rod}, {"zxy"})) EXPECT_FALSE(angles.measured);
}

TEST(AngleSequence, RefusesWhatIsNone) {
  for (const char* text : {"", "xy", "xxy", "xyy", "xYz", "abc", "xyzx", "xy1"}) {
    EXPECT_THROW(AngleSequence::Parse(text), std::invalid_argument) << text;
  }
  EXPECT_EQ(AngleSequence::Parse("ZXZ").axes, "ZXZ");
}

PoseSample RandomSample(std::mt19937_64& rng) {
  PoseSample sample = SampleAt(ExpSO3(1.2 * NormalVector<3>(rng)));
  sample.world_from_body.translation_mm = 100 * NormalVector<3>(rng);
  Matrix6d root;
  for (int i = 0; i < 6; ++i) root.col(i) = NormalVector<6>(rng);
  root.topRows<3>() *= 1e-4;
  root.bottomRows<3>() *= 1e-2;
  sample.covariance = root * root.transpose();
  return sample;
}

PoseSample Noisy(const PoseSample& sample, std::mt19937_64& rng) {
  PoseSample noisy = sample;
  const Matrix6d root = sample.covariance.llt().matrixL();
  noisy.world_from_body = Perturb(sample.world_from_body, root * NormalVector<6>(rng));
  return noisy;
}

TEST(RelativeToBody, CovarianceOfPoseAndAnglesIsTheSpread) {
  std::mt19937_64 rng = MakeTestRng();
  ErrorStatistics pose, angles;
  for (int run = 0; run < 3000; ++run) {
    const PoseSample base = RandomSample(rng), moving = RandomSample(rng);
    const Rigid3 truth = base.world_from_body.Inverse() * moving.world_from_body;
    const PoseSeries found = RelativeToBody({Noisy(base, rng)}, {Noisy(moving, rng)});
    pose.Add(PerturbationBetween(truth, found[0].world_from_body), found[0].covariance);
    PoseSeries both = {SampleAt(truth.rotation), found[0]};
    const std::vector<PoseAngles> split = AnglesOf(both, {"zxy"});
    // Within 20 σ of the lock the angles' law is not of first order.
    if (std::cos(split[0].angles_rad[1]) < 0.1) continue;
    angles.Add(split[1].angles_rad - split[0].angles_rad, split[1].covariance_rad2);
  }
  EXPECT_TRUE(IsConsistent(pose, FamilyZ(3)));
  EXPECT_TRUE(IsConsistent(angles, FamilyZ(3)));
}

TEST(RelativeToBody, OnlyCommonFramesAreMeasured) {
  std::mt19937_64 rng = MakeTestRng();
  PoseSeries base(4, RandomSample(rng)), moving(4, RandomSample(rng));
  for (int i = 0; i < 4; ++i) base[i].frame = i, moving[i].frame = i + 1;
  base[2].measured = false;
  base[3].free_axis_in_world = Eigen::Vector3d::UnitZ();
  const PoseSeries found = RelativeToBody(base, moving);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_TRUE(found[0].measured);   // frame 1
  EXPECT_FALSE(found[1].measured);  // 2: lost in the base
  EXPECT_FALSE(found[2].measured);  // 3: the base's rotation is not determined
  EXPECT_FALSE(found[3].measured);  // 4: not in the base
}

TEST(RelativeToFrame, ZeroesTheReferenceAndCarriesItsNoise) {
  std::mt19937_64 rng = MakeTestRng();
  ErrorStatistics errors;
  for (int run = 0; run < 2000; ++run) {
    const PoseSeries exact = {RandomSample(rng), RandomSample(rng)};
    const Rigid3 truth = exact[1].world_from_body.Inverse() * exact[0].world_from_body;
    const PoseSeries found = RelativeToFrame({Noisy(exact[0], rng), Noisy(exact[1], rng)}, 1);
    errors.Add(PerturbationBetween(truth, found[0].world_from_body), found[0].covariance);
    EXPECT_EQ(found[1].covariance.norm(), 0);
    EXPECT_EQ(PerturbationBetween({}, found[1].world_from_body).norm(), 0);
  }
  EXPECT_TRUE(IsConsistent(errors, FamilyZ(3)));
  PoseSeries gap(2);
  EXPECT_THROW(RelativeToFrame(gap, 0), std::invalid_argument);
  EXPECT_THROW(RelativeToFrame(gap, 2), std::invalid_argument);
}

struct Movement {
  const char* joint;
  int angle;              ///< which of the three
  Eigen::Vector3d point;  ///< of the distal body (X anterior, Y up, Z right)
  Eigen::Vector3d moves;  ///< where a small positive angle of the RIGHT side takes it
};

TEST(JointAngles, PositiveAnglesAreTheClinicalMovements) {
  const Eigen::Vector3d front(1, 0, 0), up(0, 1, 0), right(0, 0, 1);
  const Movement movements[] = {
      {"hip", 0, -up, front},    {"hip", 1, -up, -right},    {"hip", 2, front, -right},
      {"knee", 0, -up, -front},  {"knee", 1, -up, -right},   {"knee", 2, front, -right},
      {"ankle", 0, front, up},   {"ankle", 1, -up, -right},  {"ankle", 2, front, -right},
      {"spine", 0, up, front},   {"spine", 1, up, right},    {"spine", 2, front, -right},
      {"elbow", 0, -up, front},  {"elbow", 2, right, front}, {"wrist", 0, -up, front},
      {"wrist", 1, -up, -right},
  };
  for (const Movement& movement : movements) {
    const auto& all = JointConventions();
    const auto convention = std::find_if(
        all.begin(), all.end(), [&](const JointConvention& c) { return c.name == movement.joint; });
    ASSERT_NE(convention, all.end());
    const double small_rad = 0.1;
    const Eigen::Vector3d axis = movement.point.cross(movement.moves);
    const auto right_side =
        JointAngles({SampleAt(ExpSO3(small_rad * axis))}, *convention, BodySide::kRight)[0];
    EXPECT_NEAR(right_side.angles_rad[movement.angle], small_rad, 1e-12) << movement.joint;
    // The left side's movement is the mirror image: about x and y the other way round.
    const Eigen::Vector3d mirrored(-axis.x(), -axis.y(), axis.z());
    const auto left_side =
        JointAngles({SampleAt(ExpSO3(small_rad * mirrored))}, *convention, BodySide::kLeft)[0];
    EXPECT_LT((left_side.angles_rad - right_side.angles_rad).norm(), 1e-12) << movement.joint;
  }
}

TEST(JointAngles, ShoulderElevationCountsUpwardsInItsPlane) {
  const auto& all = JointConventions();
  const auto shoulder =
      std::find_if(all.begin(), all.end(), [](const auto& c) { return c.name == "shoulder"; });
  ASSERT_NE(shoulder, all.end());
  // Arm lifted by 0.5 rad: sideways (about −x; plane 0°) and forward (about +z; plane 90°).
  for (const auto& [side, mirror] : {std::pair(BodySide::kRight, 1.0), {BodySide::kLeft, -1.0}}) {
    const PoseSeries sideways = {SampleAt(ExpSO3({-0.5 * mirror, 0, 0}))};
    EXPECT_LT(
        (JointAngles(sideways, *shoulder, side)[0].angles_rad - Eigen::Vector3d(0, 0.5, 0)).norm(),
        1e-12);
    const PoseSeries forward = {SampleAt(ExpSO3({0, 0, 0.5}))};
    EXPECT_LT((JointAngles(forward, *shoulder, side)[0].angles_rad -
               Eigen::Vector3d(kPi / 2, 0.5, -kPi / 2))
                  .norm(),
              1e-12);
  }
}

}  // namespace
}  // namespace stereomotion::testing
