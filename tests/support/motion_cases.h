#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stereomotion/motion/velocity.h"
#include "tests/support/coverage_table.h"
#include "tests/support/motion_plan.h"

namespace stereomotion::testing {

/// Names a motion that tests are repeated for.
struct MotionCase {
  const char* name;
  MotionPlan (*plan)();
};

/// The seven motions whose centre follows a law, and with the eighth all of them.
std::vector<MotionCase> LawfulMotions();
std::vector<MotionCase> AllMotions();

std::string NameOf(const ::testing::TestParamInfo<MotionCase>& info);
void PrintTo(const MotionCase& one, std::ostream* stream);

/// Adds a vector as it is, or its part across an axis along which it says nothing.
void AddAcross(const std::string& quantity, const std::optional<Eigen::Vector3d>& axis,
               const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
               CoverageTable& table);
void AddNumber(const std::string& quantity, double error, double sigma, CoverageTable& table);

/// Adds ω and v (α and a too, where there are any) of a body point against the truth.
void AddVelocity(const std::string& where, const BodyVelocity& velocity, const MotionTruth& truth,
                 const Eigen::Vector3d& point_in_body_mm, CoverageTable& table);

}  // namespace stereomotion::testing
