#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "yaml_reader.h"

namespace stereomotion {

/// Holds a `covariance: {parameters: […], upper: […]}` as it was read.
struct NamedCovariance {
  std::vector<std::size_t> places;  ///< of the parameters among the known names
  Eigen::MatrixXd matrix;
};

/// Reads the covariance of some of the parameters that `names` lists, in any order. Refused:
/// unknown names (`expected` says what they should be), repeated ones, a list of the wrong length,
/// what is not positive semi-definite.
NamedCovariance ReadNamedCovariance(const YamlReader& node, const std::vector<std::string>& names,
                                    const std::string& expected);

/// Spells a covariance as the block `covariance:` of a file. `names` are spelled as YAML takes
/// them. Throws std::invalid_argument for a matrix of another size, and for what is not finite.
std::string CovarianceYaml(const std::vector<std::string>& names, const Eigen::MatrixXd& matrix);

}  // namespace stereomotion
