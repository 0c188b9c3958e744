#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "report_color.h"
#include "report_sections.h"
#include "report_text.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr int kColumns = 16, kRows = 12;
constexpr double kWidth = 560, kLeft = 62, kTop = 14, kBottom = 42, kBarSpace = 92;

std::vector<int> CountCells(const ReportData& data, int camera) {
  const CalibrationCamera& asked = data.setup.cameras[camera];
  std::vector<int> counts(kColumns * kRows, 0);
  for (const auto& r : data.calibration.residuals) {
    if (r.camera != camera || !r.used || !r.pixel_px.allFinite()) continue;
    // A pixel's centre is its whole number: the image begins at −0.5.
    const int column = static_cast<int>(kColumns * (r.pixel_px.x() + 0.5) / asked.width_px);
    const int row = static_cast<int>(kRows * (r.pixel_px.y() + 0.5) / asked.height_px);
    ++counts[std::clamp(row, 0, kRows - 1) * kColumns + std::clamp(column, 0, kColumns - 1)];
  }
  return counts;
}

std::string Cells(const PlotBox& box, const std::vector<int>& counts, int most) {
  const double width = box.width / kColumns, height = box.height / kRows;
  std::string text;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const double left = box.left + i % kColumns * width;
    const double top = box.top + static_cast<int>(i / kColumns) * height;
    const double share = static_cast<double>(counts[i]) / most;
    text += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                        Px(left), Px(top), Px(width), Px(height),
                        counts[i] > 0 ? SequentialColor(share) : "#ffffff");
    if (counts[i] == 0) continue;
    text += SvgText(left + width / 2, top + height / 2 + 3, "middle", fmt::format("{}", counts[i]),
                    fmt::format(R"(class="cell" fill="{}")", TextColorOn(share)));
  }
  return text;
}

}  // namespace

std::string CoverageFigure(const ReportData& data, int camera) {
  const CalibrationCamera& asked = data.setup.cameras[camera];
  const std::vector<int> counts = CountCells(data, camera);
  const int most = std::max(1, *std::max_element(counts.begin(), counts.end()));
  const auto filled = kColumns * kRows - std::count(counts.begin(), counts.end(), 0);
  const double width = kWidth - kLeft - kBarSpace;
  const double height = width * asked.height_px / asked.width_px;
  const PlotBox box{kLeft, kTop, width, height};
  const Axes axes({-0.5, asked.width_px - 0.5}, {asked.height_px - 0.5, -0.5}, box);
  const std::string drawing =
      Cells(box, counts, most) + axes.Frame("u [px]", "v [px]") +
      ColorBar({kLeft + width + 16, kTop, 14, height}, {0, static_cast<double>(most)},
               "image points a cell",
               [&](double number) { return SequentialColor(number / most); });
  return Figure(kWidth, kTop + height + kBottom, "Coverage of " + asked.name, drawing,
                fmt::format("Image points used, in {} × {} cells; white: none ({} of {} cells hold "
                            "points). Where there are none the lens is extrapolated.",
                            kColumns, kRows, filled, kColumns * kRows));
}

}  // namespace stereomotion
