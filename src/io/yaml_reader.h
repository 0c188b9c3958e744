#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stereomotion {

/// Reads one node of a YAML file strictly: every error is a `UserError` that names file, line and
/// key, what was found and what was expected.
class YamlReader {
 public:
  /// Parses a whole file.
  static YamlReader Load(const std::filesystem::path& file);

  /// Requires a map whose keys are all among `known`, none twice.
  void RequireKeys(const std::vector<std::string>& known) const;
  [[nodiscard]] bool IsMap() const { return node_.IsMap(); }
  [[nodiscard]] bool IsList() const { return node_.IsSequence(); }
  [[nodiscard]] bool Has(const std::string& key) const;
  [[nodiscard]] std::vector<std::string> Keys() const;

  [[nodiscard]] YamlReader Required(const std::string& key) const;
  [[nodiscard]] std::optional<YamlReader> Optional(const std::string& key) const;
  [[nodiscard]] std::vector<YamlReader> Items() const;  ///< of a list

  [[nodiscard]] double Number() const;  ///< finite
  [[nodiscard]] double Positive() const;
  [[nodiscard]] double NotNegative() const;
  [[nodiscard]] int Integer(int smallest, int largest) const;
  [[nodiscard]] std::string Text() const;
  [[nodiscard]] std::string Name() const;  ///< not empty, fit for a CSV cell and a path
  [[nodiscard]] std::vector<double> Numbers() const;
  [[nodiscard]] std::vector<double> Numbers(std::size_t count) const;
  [[nodiscard]] Eigen::Vector3d Vector3() const;

  [[noreturn]] void Fail(const std::string& found, const std::string& expected) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::string Place() const;  ///< "rig.yaml:12: cameras[0].name"

 private:
  YamlReader(std::filesystem::path file, const YAML::Node& node, std::string path, int line)
      : file_(std::move(file)), node_(node), path_(std::move(path)), line_(line) {}
  [[nodiscard]] YamlReader Child(const YAML::Node& node, const std::string& path) const;
  [[nodiscard]] std::string Found() const;
  [[nodiscard]] std::string KeyPath(const std::string& key) const;

  std::filesystem::path file_;
  YAML::Node node_;
  std::string path_;
  int line_;  // from 1
};

}  // namespace stereomotion
