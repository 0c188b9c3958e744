#include "c3d_parameters.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>

namespace stereomotion {
namespace {

constexpr std::size_t kBlock = 512;  // bytes
constexpr int kText = -1, kByte = 1, kInteger = 2, kFloat = 4;

std::string UpperCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string WithoutPadding(std::string text) {
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  while (!text.empty() && text.back() == ' ') text.pop_back();
  const std::size_t first = std::min(text.find_first_not_of(' '), text.size());
  return text.substr(first);
}

}  // namespace

std::size_t C3dParameter::count() const {
  return std::accumulate(dimensions.begin(), dimensions.end(), std::size_t{1},
                         [](std::size_t a, std::size_t b) { return a * b; });
}

C3dParameters::C3dParameters(BinaryFile& file) : file_(file) {
  const std::size_t first_block = file.Byte(0);
  if (first_block == 0) file.Fail("found parameter block 0, expected 1 or more");
  const std::size_t at = (first_block - 1) * kBlock;
  constexpr int kIntelType = 84, kDecType = 85, kMipsType = 86;
  const int processor = file.Byte(at + 3);
  if (processor < kIntelType || processor > kMipsType) {
    file.Fail("found processor type " + std::to_string(processor) +
              ", expected 84 (Intel), 85 (DEC) or 86 (MIPS)");
  }
  file.SetOrder(processor == kDecType    ? ByteOrder::kDec
                : processor == kMipsType ? ByteOrder::kMips
                                         : ByteOrder::kIntel);
  ReadSection(at + 4);
}

// Each record tells how far the next one is; the way leads forwards only, so it ends.
void C3dParameters::ReadSection(std::size_t at) {
  while (at < file_.size()) {
    const auto length =
        static_cast<std::size_t>(std::abs(static_cast<std::int8_t>(file_.Byte(at))));
    const int id = static_cast<std::int8_t>(file_.Byte(at + 1));
    if (length == 0 || id == 0) return;
    const std::string name = UpperCase(file_.Text(at + 2, length));
    const std::size_t after_name = at + 2 + length;
    const std::size_t step = file_.Word(after_name);
    if (id < 0) {
      groups_.emplace_back(-id, name);
    } else {
      ReadParameter(after_name + 2, {id, name, 0, {}, 0});
    }
    if (step < 2) return;
    at = after_name + step;
  }
}

void C3dParameters::ReadParameter(std::size_t at, C3dParameter parameter) {
  parameter.type = static_cast<std::int8_t>(file_.Byte(at));
  const std::size_t dimensions = file_.Byte(at + 1);
  constexpr std::size_t kMostDimensions = 7;
  const bool known = parameter.type == kText || parameter.type == kByte ||
                     parameter.type == kInteger || parameter.type == kFloat;
  if (!known || dimensions > kMostDimensions) {
    file_.Fail("parameter " + parameter.name + ": found type " + std::to_string(parameter.type) +
               " with " + std::to_string(dimensions) +
               " dimensions, expected type -1, 1, 2 or 4 with up to 7");
  }
  for (std::size_t i = 0; i < dimensions; ++i) {
    parameter.dimensions.push_back(file_.Byte(at + 2 + i));
  }
  parameter.data_at = at + 2 + dimensions;
  parameters_.push_back(std::move(parameter));
}

const C3dParameter* C3dParameters::Find(const std::string& group, const std::string& name) const {
  for (const C3dParameter& parameter : parameters_) {
    const bool in_group = std::find(groups_.begin(), groups_.end(),
                                    std::pair(parameter.group, group)) != groups_.end();
    if (in_group && parameter.name == name) return &parameter;
  }
  return nullptr;
}

std::optional<double> C3dParameters::Number(const std::string& group, const std::string& name,
                                            std::size_t index) const {
  const C3dParameter* parameter = Find(group, name);
  if (parameter == nullptr || index >= parameter->count()) return std::nullopt;
  switch (parameter->type) {
    case kByte:
      return file_.Byte(parameter->data_at + index);
    case kInteger:
      return file_.Word(parameter->data_at + 2 * index);
    case kFloat:
      return file_.Float(parameter->data_at + 4 * index);
    default:
      return std::nullopt;
  }
}

std::vector<std::string> C3dParameters::Texts(const std::string& group,
                                              const std::string& name) const {
  const C3dParameter* parameter = Find(group, name);
  if (parameter == nullptr || parameter->type != kText || parameter->dimensions.empty()) return {};
  const std::size_t length = parameter->dimensions[0];
  const std::size_t count = length > 0 ? parameter->count() / length : 0;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    texts.push_back(WithoutPadding(file_.Text(parameter->data_at + i * length, length)));
  }
  return texts;
}

}  // namespace stereomotion
