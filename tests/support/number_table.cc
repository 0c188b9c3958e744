#include "tests/support/number_table.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "stereomotion/capture/read_image.h"

namespace stereomotion::testing {

std::vector<std::vector<double>> ReadNumbers(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0; words >> value;) row.push_back(value);
    if (!row.empty()) rows.push_back(row);
  }
  return rows;
}

Image ReadGrey(const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes;
  Image image;
  std::string problem = ReadBytes(file, bytes);
  if (problem.empty()) problem = DecodeImage(bytes, image);
  if (!problem.empty()) throw std::runtime_error(file.string() + ": " + problem);
  return image;
}

}  // namespace stereomotion::testing
