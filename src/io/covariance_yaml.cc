#include "covariance_yaml.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "number_text.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

std::vector<std::size_t> ReadPlaces(const YamlReader& node, const std::vector<std::string>& names,
                                    const std::string& expected) {
  std::vector<std::size_t> places;
  std::vector<bool> used(names.size(), false);
  for (const YamlReader& item : node.Items()) {
    const std::string name = item.Text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      item.Fail("'" + name + "'", expected + " as in " + names.front() + DidYouMean(name, names));
    }
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (used[place]) item.Fail("'" + name + "' twice", "every parameter once");
    used[place] = true;
    places.push_back(place);
  }
  return places;
}

Eigen::MatrixXd ReadUpper(const YamlReader& upper, Eigen::Index n) {
  const std::vector<double> values = upper.Numbers();
  if (static_cast<Eigen::Index>(values.size()) != n * (n + 1) / 2) {
    upper.Fail("a list of " + std::to_string(values.size()),
               std::to_string(n * (n + 1) / 2) + " numbers, the upper triangle of " +
                   std::to_string(n) + " parameters row by row");
  }
  Eigen::MatrixXd matrix(n, n);
  auto value = values.begin();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i; j < n; ++j) matrix(i, j) = matrix(j, i) = *value++;
  }
  return matrix;
}

// Compares in units of the standard deviations: parameters differ by many powers of ten.
void RequireSemiDefinite(const YamlReader& node, const Eigen::MatrixXd& matrix) {
  const Eigen::Index n = matrix.rows();
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (matrix(i, i) < 0) {
      node.Fail("the negative variance " + std::to_string(matrix(i, i)) + " of parameter " +
                    std::to_string(i),
                "0 or more");
    }
    const bool alone = matrix.row(i).cwiseAbs().sum() == 0;
    if (matrix(i, i) == 0 && !alone) {
      node.Fail("covariances of parameter " + std::to_string(i) + " that has variance 0", "none");
    }
    scale[i] = alone ? 1 : 1 / std::sqrt(matrix(i, i));
  }
  const Eigen::MatrixXd correlation = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  constexpr double kRounding = 1e-5;  // of numbers written with six digits
  if (n > 0 && solver.eigenvalues()[0] < -kRounding) {
    node.Fail("a matrix with the negative eigenvalue " + std::to_string(solver.eigenvalues()[0]) +
                  " (as correlations)",
              "a positive semi-definite covariance");
  }
}

}  // namespace

NamedCovariance ReadNamedCovariance(const YamlReader& node, const std::vector<std::string>& names,
                                    const std::string& expected) {
  node.RequireKeys({"parameters", "upper"});
  NamedCovariance covariance;
  covariance.places = ReadPlaces(node.Required("parameters"), names, expected);
  const YamlReader upper = node.Required("upper");
  covariance.matrix = ReadUpper(upper, static_cast<Eigen::Index>(covariance.places.size()));
  RequireSemiDefinite(upper, covariance.matrix);
  return covariance;
}

std::string CovarianceYaml(const std::vector<std::string>& names, const Eigen::MatrixXd& matrix) {
  const auto n = static_cast<Eigen::Index>(names.size());
  if (matrix.rows() != n || matrix.cols() != n) {
    throw std::invalid_argument("the covariance does not fit its parameters");
  }
  std::string text = "covariance:\n  parameters: [";
  constexpr std::size_t kNamesALine = 5;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i % kNamesALine == 0 ? ",\n               " : ", ";
    text += names[i];
  }
  text += "]\n  upper: [";
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i > 0) text += ",\n          ";
    for (Eigen::Index j = i; j < n; ++j) text += (j > i ? ", " : "") + NumberText(matrix(i, j));
  }
  return text + "]\n";
}

}  // namespace stereomotion
