#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rig_formats.h"
#include "stereomotion/io/suggest.h"

namespace stereomotion {
namespace {

std::vector<std::string> AllNames(const Rig& rig) {
  std::vector<std::string> names;
  for (int camera = 0; camera < static_cast<int>(rig.cameras.size()); ++camera) {
    for (int index = 0; index < RigParameter::kPerCamera; ++index) {
      names.push_back(RigParameterName(rig, {camera, index}));
    }
  }
  return names;
}

std::vector<RigParameter> ReadParameters(const YamlReader& node, const Rig& rig) {
  const std::vector<std::string> names = AllNames(rig);
  std::vector<RigParameter> parameters;
  std::vector<bool> used(names.size(), false);
  for (const YamlReader& item : node.Items()) {
    const std::string name = item.Text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      item.Fail("'" + name + "'",
                "a camera's parameter as in " + names.front() + DidYouMean(name, names));
    }
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (used[place]) item.Fail("'" + name + "' twice", "every parameter once");
    used[place] = true;
    const int n = static_cast<int>(place);
    parameters.push_back({n / RigParameter::kPerCamera, n % RigParameter::kPerCamera});
  }
  return parameters;
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

RigCovariance ReadRigCovariance(const YamlReader& node, const Rig& rig) {
  node.RequireKeys({"parameters", "upper"});
  RigCovariance covariance;
  covariance.parameters = ReadParameters(node.Required("parameters"), rig);
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  const YamlReader upper = node.Required("upper");
  const std::vector<double> values = upper.Numbers();
  if (static_cast<Eigen::Index>(values.size()) != n * (n + 1) / 2) {
    upper.Fail("a list of " + std::to_string(values.size()),
               std::to_string(n * (n + 1) / 2) + " numbers, the upper triangle of " +
                   std::to_string(n) + " parameters row by row");
  }
  covariance.matrix.resize(n, n);
  auto value = values.begin();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = i; j < n; ++j) {
      covariance.matrix(i, j) = covariance.matrix(j, i) = *value++;
    }
  }
  RequireSemiDefinite(upper, covariance.matrix);
  return covariance;
}

}  // namespace stereomotion
