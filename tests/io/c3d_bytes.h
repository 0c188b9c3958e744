#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace stereomotion::testing {

/// Builds small C3D files byte by byte, after c3d.org's format, in any byte order.
class C3dBytes {
 public:
  enum Processor { kIntel = 84, kDec = 85, kMips = 86 };

  Processor processor = kIntel;
  bool integers = false;
  float scale = 0.1F;
  float rate_hz = 50;
  std::string units = "mm";
  int analog_per_frame = 0;
  bool long_frames = false;  ///< the number of frames stands in TRIAL
  std::vector<std::string> labels{"A", "B", "C"};
  /// frames × points × (x, y, z, residual), in the file's units
  std::vector<std::vector<std::vector<float>>> frames;

  [[nodiscard]] std::string Build() const {
    const std::string parameters = Parameters();
    const auto blocks = static_cast<int>((parameters.size() + 511) / 512);
    std::string file;
    file += static_cast<char>(2);
    file += static_cast<char>(0x50);
    for (const int word : {static_cast<int>(labels.size()), analog_per_frame, 1,
                           long_frames ? 65535 : static_cast<int>(frames.size()), 0}) {
      file += Word(word);
    }
    file += Float(integers ? scale : -scale);
    file += Word(2 + blocks) + Word(1) + Float(rate_hz);
    file.resize(512);
    file += parameters;
    file.resize(512 + static_cast<std::size_t>(blocks) * 512);
    return file + Data();
  }

 private:
  [[nodiscard]] std::string Word(int number) const {
    const char low = static_cast<char>(number & 0xff), high = static_cast<char>(number >> 8 & 0xff);
    return processor == kMips ? std::string{high, low} : std::string{low, high};
  }

  [[nodiscard]] std::string Float(float number) const {
    if (processor == kDec) number *= 4;
    std::uint32_t bits = 0;
    std::memcpy(&bits, &number, 4);
    const std::string upper = Word(static_cast<int>(bits >> 16U));
    const std::string lower = Word(static_cast<int>(bits & 0xffffU));
    return processor == kIntel ? lower + upper : upper + lower;
  }

  // Every record ends with the way to the next one.
  [[nodiscard]] std::string Record(const std::string& name, int id, const std::string& body) const {
    std::string record;
    record += static_cast<char>(name.size());
    record += static_cast<char>(id);
    return record + name + Word(static_cast<int>(body.size()) + 2) + body;
  }

  [[nodiscard]] std::string Parameter(const std::string& name, int id, int type,
                                      const std::vector<int>& dimensions,
                                      const std::string& data) const {
    std::string body{static_cast<char>(type), static_cast<char>(dimensions.size())};
    for (const int dimension : dimensions) body += static_cast<char>(dimension);
    return Record(name, id, body + data + '\0');
  }

  [[nodiscard]] std::string Parameters() const {
    constexpr int kText = -1, kInteger = 2, kFloat = 4, kWidth = 8;
    std::string names;
    for (std::string label : labels) {
      label.resize(kWidth, ' ');
      names += label;
    }
    const auto points = static_cast<int>(labels.size());
    std::string section{'\1', '\x50', '\1', static_cast<char>(processor)};
    section += Record("POINT", -1, std::string(1, '\0'));
    section += Parameter("USED", 1, kInteger, {}, Word(points));
    section += Parameter("SCALE", 1, kFloat, {}, Float(integers ? scale : -scale));
    section += Parameter("RATE", 1, kFloat, {}, Float(rate_hz));
    section += Parameter("UNITS", 1, kText, {static_cast<int>(units.size())}, units);
    // The second half of the names in LABELS2, as files with more than 255 points have them.
    const int first = points / 2;
    const auto half = static_cast<std::size_t>(first) * kWidth;
    section += Parameter("LABELS", 1, kText, {kWidth, first}, names.substr(0, half));
    section += Parameter("LABELS2", 1, kText, {kWidth, points - first}, names.substr(half));
    if (long_frames) {
      const auto count = static_cast<int>(frames.size());
      section += Record("TRIAL", -2, std::string(1, '\0'));
      section += Parameter("ACTUAL_START_FIELD", 2, kInteger, {2}, Word(1) + Word(0));
      section +=
          Parameter("ACTUAL_END_FIELD", 2, kInteger, {2}, Word(count & 0xffff) + Word(count >> 16));
    }
    return section + std::string(2, '\0');
  }

  [[nodiscard]] std::string Data() const {
    std::string data;
    for (const auto& frame : frames) {
      for (const auto& point : frame) {
        for (std::size_t k = 0; k < 4; ++k) {
          const bool residual = k == 3;
          data += !integers ? Float(point[k])
                            : Word(static_cast<int>(residual ? point[k] : point[k] / scale));
        }
      }
      for (int i = 0; i < analog_per_frame; ++i) data += integers ? Word(7) : Float(7);
    }
    return data;
  }
};

}  // namespace stereomotion::testing
