#pragma once

#include <optional>
#include <string>
#include <vector>

#include "binary_file.h"

namespace stereomotion {

/// Holds where one parameter of a C3D file stands.
struct C3dParameter {
  int group = 0;
  std::string name;  ///< upper case
  int type = 0;      ///< −1 text, 1 byte, 2 integer, 4 float
  std::vector<std::size_t> dimensions;
  std::size_t data_at = 0;

  [[nodiscard]] std::size_t count() const;
};

/// Reads the parameter section of a C3D file (c3d.org, The C3D File Format, User Guide 2008). Sets
/// the file's byte order by the section's processor type.
class C3dParameters {
 public:
  explicit C3dParameters(BinaryFile& file);

  /// Finds a parameter; nullptr: there is none.
  [[nodiscard]] const C3dParameter* Find(const std::string& group, const std::string& name) const;
  /// Gives a parameter's first number, or its `index`-th; integers count as unsigned.
  [[nodiscard]] std::optional<double> Number(const std::string& group, const std::string& name,
                                             std::size_t index = 0) const;
  /// Gives a parameter's texts, without the blanks at their ends.
  [[nodiscard]] std::vector<std::string> Texts(const std::string& group,
                                               const std::string& name) const;

 private:
  void ReadSection(std::size_t at);
  void ReadParameter(std::size_t at, C3dParameter parameter);

  BinaryFile& file_;
  std::vector<std::pair<int, std::string>> groups_;
  std::vector<C3dParameter> parameters_;
};

}  // namespace stereomotion
