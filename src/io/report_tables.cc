#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report_sections.h"
#include "report_text.h"
#include "report_verdict.h"

namespace stereomotion {
namespace {

// χ² of three coordinates exceeds 16.27 once in a thousand.
const double kSuspectSigmas = std::sqrt(16.27);

std::string Code(const std::string& text) { return "<code>" + EscapeHtml(text) + "</code>"; }

std::string ViewNote(const ReportData& data, std::size_t view) {
  if (!data.calibration.view_used[view]) return "not used";
  std::string note;
  for (std::size_t c = 0; c < data.setup.cameras.size(); ++c) {
    if (!data.summary.outlying[view][c]) continue;
    note += (note.empty() ? "outlying: " : ", ") + EscapeHtml(data.setup.cameras[c].name);
  }
  return note;
}

}  // namespace

std::string VerdictSection(const ReportData& data) {
  const VerdictLevel level = data.summary.level;
  std::string text = fmt::format("<section class=\"verdict {}\"><p class=\"level\">{}</p>\n<ul>\n",
                                 VerdictName(level), VerdictWords(level));
  for (const auto& sentence : VerdictSentences(data.calibration, data.setup, data.summary)) {
    text += "<li>" + EscapeHtml(sentence) + "</li>\n";
  }
  return text + "</ul></section>\n";
}

std::string WarningsSection(const ReportData& data) {
  if (data.calibration.warnings.empty()) {
    return "<section><h2>Warnings</h2><p>None.</p></section>\n";
  }
  std::string text = "<section><h2>Warnings</h2>\n<dl>\n";
  for (const CalibrationNote& note : data.calibration.warnings) {
    const std::string advice = Advice(note.name);
    text += fmt::format("<dt>{}</dt><dd>{}{}</dd>\n", Code(note.name), EscapeHtml(note.text),
                        advice.empty() ? "" : "<br/><i>" + EscapeHtml(advice) + "</i>");
  }
  return text + "</dl></section>\n";
}

std::string ImagesSection(const ReportData& data) {
  std::string text = "<section><h2>Images</h2>\n";
  for (int c = 0; c < static_cast<int>(data.setup.cameras.size()); ++c) {
    const ResidualCount& count = data.summary.cameras[c];
    text += fmt::format(
        "<h3>{}</h3>\n<p>{} image points used, {} left out; RMS {} px a coordinate.</p>\n"
        "<div class=\"figures\">\n",
        EscapeHtml(data.setup.cameras[c].name), count.used, count.left_out,
        Digits(count.RmsPx(), 3));
    text += ResidualVectorsFigure(data, c) + CoverageFigure(data, c) +
            ResidualRadiusFigure(data, c) + "</div>\n";
  }
  return text + "</section>\n";
}

std::string OutliersSection(const ReportData& data) {
  std::map<std::pair<int, int>, std::string> by_image;
  for (const auto& r : data.calibration.residuals) {
    if (r.used) continue;
    std::string& list = by_image[{r.camera, r.view}];
    list += fmt::format("{}{} ({} px)", list.empty() ? "" : ", ",
                        Code(PointId(data.setup, r.point)), Digits(r.residual_px.norm(), 2));
  }
  if (by_image.empty()) return "";
  HtmlTable table("lrl", {"camera", "view", "points (distance from where they are expected)"});
  for (const auto& [image, list] : by_image) {
    table.AddRow(
        {EscapeHtml(data.setup.cameras[image.first].name), fmt::format("{}", image.second), list});
  }
  return "<section><h2>Outliers</h2>\n<p>These image points do not fit and were left out of the "
         "fit.</p>\n" +
         table.Text() + "</section>\n";
}

std::string CheckPointsSection(const ReportData& data) {
  if (data.calibration.check_points.empty()) return "";
  HtmlTable table("lrrrrrrr", {"point", "Δx mm", "Δy mm", "Δz mm", "distance mm", "expected mm",
                               "in σ", "cameras"});
  for (const CheckPoint& check : data.calibration.check_points) {
    const auto in_sigmas = ErrorInSigmas(check);
    const double expected_mm = std::sqrt(check.covariance_mm2.trace());
    const auto coordinate = [covariance = check.covariance_mm2, error = check.error_mm](int i) {
      return ValueText(error[i], std::sqrt(covariance(i, i)));
    };
    const bool suspect = in_sigmas.value_or(0) > kSuspectSigmas;
    table.AddRow(
        {Code(PointId(data.setup, check.point)), coordinate(0), coordinate(1), coordinate(2),
         ValueText(check.error_mm.norm(), expected_mm), Digits(expected_mm, 2),
         Digits(in_sigmas, 2), fmt::format("{}", check.num_cameras)},
        suspect ? "bad" : "");
  }
  return "<section><h2>Check points</h2>\n<p>Points kept out of the fit, triangulated − surveyed. "
         "Expected: image noise, calibration and the point's own survey together. “In σ” is "
         "√(e<sup>T</sup>Σ<sup>−1</sup>e), 1.7 on average; above 4.0 (once in a thousand) it is "
         "marked.</p>\n" +
         table.Text() + "</section>\n";
}

std::string ViewsSection(const ReportData& data) {
  const bool blur = !data.inputs.blur_px.empty();
  std::string columns = "r";
  std::vector<std::string> heads = {"view"};
  for (const auto& camera : data.setup.cameras) {
    columns += blur ? "lrrrr" : "lrrr";
    const std::string name = EscapeHtml(camera.name);
    for (const char* head : {"", " RMS px", " used", " left out"}) heads.push_back(name + head);
    if (blur) heads.push_back(name + " blur px");
  }
  heads.emplace_back("");
  HtmlTable table(columns + "l", heads);
  for (std::size_t v = 0; v < data.summary.images.size(); ++v) {
    std::vector<std::string> cells = {fmt::format("{}", v)};
    for (std::size_t c = 0; c < data.setup.cameras.size(); ++c) {
      const ResidualCount& image = data.summary.images[v][c];
      const int camera = static_cast<int>(c), view = static_cast<int>(v);
      cells.push_back(Code(ImageName(data.inputs, camera, view)));
      cells.push_back(Digits(image.RmsPx(), 2));
      cells.push_back(fmt::format("{}", image.used));
      cells.push_back(fmt::format("{}", image.left_out));
      if (blur) cells.push_back(Digits(BlurPx(data.inputs, camera, view), 2));
    }
    const std::string note = ViewNote(data, v);
    cells.push_back(note);
    table.AddRow(cells, note.empty() ? "" : "bad");
  }
  return "<section><h2>Views</h2>\n<p>Outlying: RMS above twice the median over the camera's "
         "images, "
         "or more points left out than used.</p>\n" +
         table.Text() + "</section>\n";
}

std::string InputsSection(const ReportData& data) {
  HtmlTable table("lll", {"role", "file", "SHA-256"});
  for (const RunInput& file : data.inputs.files) {
    table.AddRow({EscapeHtml(file.role), Code(file.path), Code(file.sha256)});
  }
  std::string command;
  for (const auto& word : data.inputs.command) command += (command.empty() ? "" : " ") + word;
  return "<section class=\"inputs\"><h2>Inputs</h2>\n" +
         (command.empty() ? "" : "<p>" + Code(command) + "</p>\n") +
         (data.inputs.files.empty() ? "" : table.Text()) + "</section>\n";
}

}  // namespace stereomotion
