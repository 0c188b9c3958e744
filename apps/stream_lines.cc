#include "stream_lines.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "stereomotion/pose/status_words.h"
#include "version.h"

namespace stereomotion::app {
namespace {

// JSON in UTF-8; body and camera names may hold any character that a file name may.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += fmt::format("\\{}", c);
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string List(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ",") + Quoted(text);
  return "[" + list + "]";
}

// Shortest digits that give the number back, as in poses.csv; JSON knows no infinity.
void AppendNumber(double number, std::string& line) {
  if (std::isfinite(number)) {
    fmt::format_to(std::back_inserter(line), "{}", number);
  } else {
    line += "null";
  }
}

class ListWriter {
 public:
  ListWriter(const char* key, std::string& line) : line_(line) {
    fmt::format_to(std::back_inserter(line), ",\"{}\":[", key);
  }
  void Add(double number) {
    if (!first_) line_ += ',';
    first_ = false;
    AppendNumber(number, line_);
  }
  void End() { line_ += ']'; }

 private:
  std::string& line_;
  bool first_ = true;
};

void AppendPose(const PoseEstimate& pose, std::string& line) {
  const Eigen::Quaterniond& q = pose.world_from_body.rotation;
  ListWriter rotation("q", line);
  for (const double number : {q.w(), q.x(), q.y(), q.z()}) rotation.Add(number);
  rotation.End();
  ListWriter place("t_mm", line);
  for (int i = 0; i < 3; ++i) place.Add(pose.world_from_body.translation_mm[i]);
  place.End();
  ListWriter covariance("cov", line);
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) covariance.Add(pose.covariance(i, j));
  }
  covariance.End();
  if (!pose.free_axis_in_world) return;
  ListWriter axis("free_axis", line);
  for (int i = 0; i < 3; ++i) axis.Add((*pose.free_axis_in_world)[i]);
  axis.End();
}

}  // namespace

std::string HelloLine(const StreamHello& hello) {
  return fmt::format(
      "{{\"format\":\"stereomotion-stream/1\",\"version\":\"{}\",\"cameras\":{},\"bodies\":{},"
      "\"live\":{}}}\n",
      kVersion, List(hello.cameras), List(hello.bodies), hello.live);
}

void PoseLine(const PromptPose& prompt, const std::string& body, std::optional<double> latency_ms,
              std::string& line) {
  line.clear();
  fmt::format_to(std::back_inserter(line),
                 R"({{"frame":{},"timestamp_ns":{},"body":{},"status":"{}")", prompt.frame,
                 prompt.timestamp_ns, Quoted(body), StatusWord(prompt.status));
  if (prompt.pose != nullptr) {
    AppendPose(*prompt.pose, line);
    fmt::format_to(std::back_inserter(line), R"(,"balls":[{},{}],"rms_px":)",
                   prompt.pose->balls_left, prompt.pose->balls_right);
    AppendNumber(prompt.pose->rms_px, line);
  }
  if (latency_ms) fmt::format_to(std::back_inserter(line), ",\"latency_ms\":{:.2f}", *latency_ms);
  line += "}\n";
}

std::string EndLine(const std::string& reason, std::int64_t pairs, std::int64_t lost_lines) {
  return fmt::format("{{\"end\":{},\"pairs\":{},\"lost_lines\":{}}}\n", Quoted(reason), pairs,
                     lost_lines);
}

}  // namespace stereomotion::app
