#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace stereomotion {

/// Spells a JSON value so that a person can read it: what holds only numbers and words (a residual,
/// a row of a matrix) stands on one line.
std::string JsonText(const nlohmann::ordered_json& json, const std::string& indent = "");

/// Makes a number of ten significant digits; null of what is not finite.
nlohmann::ordered_json JsonNumber(double number);

/// Makes a list of numbers, and of a matrix a list of its rows.
nlohmann::ordered_json JsonVector(const Eigen::VectorXd& vector);
nlohmann::ordered_json JsonMatrix(const Eigen::MatrixXd& matrix);

/// Makes null of what is not there.
template <class Vector>
nlohmann::ordered_json JsonVectorOrNull(const std::optional<Vector>& vector) {
  return vector ? JsonVector(*vector) : nlohmann::ordered_json(nullptr);
}

}  // namespace stereomotion
