#include "tests/support/motion_cases.h"

#include "tests/support/motion_bound.h"

namespace stereomotion::testing {

std::vector<MotionCase> LawfulMotions() {
  return {{"Fixed", FixedMotion},
          {"Uniform", UniformMotion},
          {"Accelerated", AcceleratedMotion},
          {"Screw", ScrewMotion},
          {"Precession", PrecessionMotion},
          {"SmallRange", SmallRangeMotion},
          {"SingleAxis", SingleAxisMotion}};
}

std::vector<MotionCase> AllMotions() {
  std::vector<MotionCase> all = LawfulMotions();
  all.push_back({"Random", RandomMotion});
  return all;
}

std::string NameOf(const ::testing::TestParamInfo<MotionCase>& info) { return info.param.name; }

void PrintTo(const MotionCase& one, std::ostream* stream) { *stream << one.name; }

void AddAcross(const std::string& quantity, const std::optional<Eigen::Vector3d>& axis,
               const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
               CoverageTable& table) {
  if (!axis) return table.Add(quantity, error, covariance);
  const auto ways = Across(*axis);
  table.Add(quantity, ways.transpose() * error, ways.transpose() * covariance * ways);
}

void AddNumber(const std::string& quantity, double error, double sigma, CoverageTable& table) {
  table.Add(quantity, Eigen::VectorXd::Constant(1, error),
            Eigen::MatrixXd::Constant(1, 1, sigma * sigma));
}

void AddVelocity(const std::string& where, const BodyVelocity& velocity, const MotionTruth& truth,
                 const Eigen::Vector3d& point_in_body_mm, CoverageTable& table) {
  const auto block = [&](Eigen::Index at) { return velocity.covariance.block<3, 3>(at, at); };
  table.Add("omega, " + where, velocity.omega_rad_s - truth.omega_rad_s, block(0));
  table.Add("v, " + where, velocity.velocity_mm_s - truth.VelocityOf(point_in_body_mm), block(3));
  if (!velocity.has_acceleration) return;
  table.Add("alpha, " + where, velocity.alpha_rad_s2 - truth.alpha_rad_s2, block(6));
  table.Add("a, " + where, velocity.acceleration_mm_s2 - truth.AccelerationOf(point_in_body_mm),
            block(9));
}

}  // namespace stereomotion::testing
