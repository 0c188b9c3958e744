#include "stereomotion/io/body_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "io_test_support.h"
#include "stereomotion/io/body_file.h"
#include "tests/support/test_rng.h"

namespace stereomotion {
namespace {

using testing::Error;
using testing::Has;
using testing::MakeTestRng;
using testing::TextFile;

Body RandomBody(std::mt19937_64& rng) {
  Body body;
  body.name = "null";
  for (const char* name : {"A", "y", "0x1 :#"}) {
    Rod rod{name, testing::Uniform(rng, 10, 20), {}, testing::Uniform(rng, 0.01, 0.1)};
    const Eigen::Vector3d direction = testing::NormalVector<3>(rng).normalized();
    const Eigen::Vector3d first_mm = 100 * testing::NormalVector<3>(rng);
    for (const double along_mm : {0.0, 40.0, 95.0}) {
      rod.balls_in_body_mm.push_back(first_mm + along_mm * direction);
    }
    body.rods.push_back(rod);
  }
  return body;
}

// As a learned body has it: of lower rank than its size.
Eigen::MatrixXd RandomCovariance(std::mt19937_64& rng, Eigen::Index n) {
  Eigen::MatrixXd root(n, n - 6);
  for (Eigen::Index i = 0; i < root.size(); ++i) root.data()[i] = 0.01 * testing::Normal(rng);
  const Eigen::MatrixXd product = root * root.transpose();
  return product.selfadjointView<Eigen::Upper>();  // symmetrical to the last digit
}

TEST(BodyWriter, RoundTrip) {
  auto rng = MakeTestRng();
  for (const bool with_covariance : {false, true}) {
    Body body = RandomBody(rng);
    if (with_covariance) body.covariance_mm2 = RandomCovariance(rng, 27);
    const std::string text = BodyYaml(body, "learned\nof nothing");
    const Body read = ReadBody(TextFile("body.yaml", text).path());
    EXPECT_EQ(read.name, body.name);
    ASSERT_EQ(read.rods.size(), body.rods.size());
    for (std::size_t i = 0; i < body.rods.size(); ++i) {
      EXPECT_EQ(read.rods[i].name, body.rods[i].name);
      EXPECT_EQ(read.rods[i].ball_diameter_mm, body.rods[i].ball_diameter_mm);
      EXPECT_EQ(read.rods[i].balls_in_body_mm, body.rods[i].balls_in_body_mm);
      EXPECT_EQ(read.rods[i].sigma_mm, body.rods[i].sigma_mm);
    }
    ASSERT_EQ(read.covariance_mm2.size(), body.covariance_mm2.size());
    EXPECT_TRUE(read.covariance_mm2 == body.covariance_mm2);
    EXPECT_TRUE(Has(text, "# learned\n# of nothing\nformat:"));
  }
}

TEST(BodyWriter, CovarianceOfSomeCoordinates) {
  Body body{"body", {{"A", 14, {{0, 0, 0}, {40, 0, 0}, {95, 0, 0}}, 0.1}}, {}};
  const std::string text =
      BodyYaml(body) + "covariance: {parameters: [A.1.y_mm, A.0.x_mm], upper: [4, 1, 9]}\n";
  const Body read = ReadBody(TextFile("body.yaml", text).path());
  ASSERT_EQ(read.covariance_mm2.rows(), 9);
  EXPECT_EQ(read.covariance_mm2(4, 4), 4);
  EXPECT_EQ(read.covariance_mm2(4, 0), 1);
  EXPECT_EQ(read.covariance_mm2(0, 4), 1);
  EXPECT_EQ(read.covariance_mm2(0, 0), 9);
  EXPECT_DOUBLE_EQ(read.covariance_mm2(8, 8), 0.01);  // not named: sigma_mm
}

TEST(BodyWriter, RefusedCovariances) {
  const Body body{"body", {{"A", 14, {{0, 0, 0}, {40, 0, 0}, {95, 0, 0}}, 0.1}}, {}};
  const auto error = [&](const std::string& parameters, const std::string& upper) {
    const TextFile file("body.yaml", BodyYaml(body) + "covariance: {parameters: [" + parameters +
                                         "], upper: [" + upper + "]}\n");
    return Error([&] { ReadBody(file.path()); });
  };
  EXPECT_TRUE(Has(error("A.0.x_mm, A.1.x_mm", "1, 0"), "found a list of 2, expected 3 numbers"));
  EXPECT_TRUE(Has(error("A.0.x", "1"), "did you mean 'A.0.x_mm'?"));
  EXPECT_TRUE(Has(error("B.0.x_mm", "1"), "expected a coordinate of a ball as in A.0.x_mm"));
  EXPECT_TRUE(Has(error("A.0.x_mm, A.0.x_mm", "1, 0, 1"), "'A.0.x_mm' twice"));
  EXPECT_TRUE(Has(error("A.0.x_mm, A.1.x_mm", "1, 2, 1"), "positive semi-definite"));
  EXPECT_TRUE(Has(error("A.0.x_mm", "-1"), "negative variance"));
}

TEST(BodyWriter, WhatNoFileCanHold) {
  Body body{"body", {{"A", 14, {{0, 0, 0}, {40, 0, 0}, {95, 0, std::nan("")}}, 0}}, {}};
  EXPECT_THROW(BodyYaml(body), std::invalid_argument);
  body.rods[0].balls_in_body_mm[2].z() = 0;
  body.covariance_mm2 = Eigen::MatrixXd::Identity(8, 8);
  EXPECT_THROW(BodyYaml(body), std::invalid_argument);
}

}  // namespace
}  // namespace stereomotion
