#include <fmt/format.h>

#include <set>

#include "report_text.h"
#include "run_sections.h"

namespace stereomotion {
namespace {

std::string Code(const std::string& text) { return "<code>" + EscapeHtml(text) + "</code>"; }

// As a shell reads it back as one word.
std::string ShellQuoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string Share(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return "";
  return Digits(100.0 * static_cast<double>(part) / static_cast<double>(whole), 3) + " %";
}

std::string PairsTable(const RunReport& report) {
  const RunSummary& summary = report.record.summary;
  HtmlTable table("lrr", {"frame pairs", "number", "share"});
  table.AddRow({"read", std::to_string(summary.pairs_read), ""});
  for (const BodySummary& body : TotalsOfBodies(report)) {
    const std::string whose = report.bodies.size() > 1 ? EscapeHtml(body.name) + ": " : "";
    table.AddRow(
        {whose + "with a pose", std::to_string(body.poses), Share(body.poses, summary.pairs_read)});
    for (const auto& [reason, count] : body.lost_by_reason) {
      table.AddRow({whose + Code(reason), std::to_string(count), Share(count, summary.pairs_read)},
                   "bad");
    }
  }
  if (summary.poses_moved_to_mid_exposure > 0) {
    table.AddRow({"moved to mid-exposure", std::to_string(summary.poses_moved_to_mid_exposure),
                  Share(summary.poses_moved_to_mid_exposure, summary.pairs_read)});
  }
  return table.Text();
}

std::string HowText(const RunRecord& record) {
  const RunSummary& summary = record.summary;
  std::string text = fmt::format("Detector {}. ", Code(record.detector));
  if (record.search_every > 1) {
    text += fmt::format(
        "Every {} pair was searched whole (images: left {}, right {}), the others only where the "
        "balls seen before should be: a ball that came into sight may be up to {} late. ",
        Ordinal(record.search_every), summary.whole_searches_left, summary.whole_searches_right,
        Counted(record.search_every - 1, "pair"));
  }
  if (summary.elapsed_ms > 0) {
    text +=
        fmt::format("{} pairs a second on {}.",
                    Digits(1000 * static_cast<double>(summary.pairs_read) / summary.elapsed_ms, 3),
                    Counted(record.threads, "thread"));
  }
  return "<p>" + text + "</p>\n";
}

void AddNoise(const std::string& camera, const NoiseRecord& record, HtmlTable& table) {
  const SensorNoise& noise = record.noise;
  table.AddRow({EscapeHtml(camera), Digits(noise.gain_e_per_dn, 4), Digits(noise.read_e, 3),
                Digits(noise.black_dn, 3), Digits(noise.saturation_dn, 5),
                EscapeHtml(record.origin) + (record.pairs_used > 0
                                                 ? " from " + Counted(record.pairs_used, "image")
                                                 : std::string())});
}

std::string NoiseTable(const RunRecord& record) {
  HtmlTable table("lrrrrl", {"camera", "gain [e/DN]", "read noise [e]", "black [DN]",
                             "saturation [DN]", "origin"});
  AddNoise(record.left_camera, record.summary.noise_left, table);
  AddNoise(record.right_camera, record.summary.noise_right, table);
  return "<h3>Noise model</h3>\n" + table.Text();
}

std::string BlobTable(const RunReport& report) {
  std::set<std::string> words;
  for (const int camera : {0, 1}) {
    for (const auto& [word, count] : report.bodies.front().trace->blobs(camera)) words.insert(word);
  }
  if (words.empty()) return "";
  const auto count = [&](int camera, const std::string& word) {
    const auto& blobs = report.bodies.front().trace->blobs(camera);
    const auto found = blobs.find(word);
    return std::to_string(found == blobs.end() ? 0 : found->second);
  };
  HtmlTable table("lrr", {"blobs taken for balls", EscapeHtml(report.record.left_camera),
                          EscapeHtml(report.record.right_camera)});
  for (const std::string& word : words) {
    table.AddRow({Code(word), count(0, word), count(1, word)});
  }
  return "<h3>Blobs</h3>\n" + table.Text();
}

}  // namespace

std::string RunNumbersSection(const RunReport& report) {
  return "<section><h2>The run in numbers</h2>\n" + PairsTable(report) + HowText(report.record) +
         BlobTable(report) + NoiseTable(report.record) + "</section>\n";
}

std::string RunInputsSection(const RunReport& report) {
  const RunRecord& record = report.record;
  HtmlTable table("lll", {"input", "path", "SHA-256"});
  for (const RunInput& input : record.inputs) {
    table.AddRow({EscapeHtml(input.role), Code(input.path), Code(input.sha256)});
  }
  std::string command;
  for (const std::string& word : record.command) {
    command += (command.empty() ? "" : " ") + ShellQuoted(word);
  }
  return "<section><h2>Inputs</h2>\n" + table.Text() + "<p>" + Code(command) + "</p></section>\n";
}

}  // namespace stereomotion
