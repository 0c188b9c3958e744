#include "stereomotion/calibration/print_target.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace stereomotion {
namespace {

constexpr double kBarMm = 100;
constexpr double kBarHeightMm = 3;
constexpr double kTextMm = 4;     ///< height of letters
constexpr double kFooterMm = 20;  ///< bar and two lines of text

struct Layout {
  double width_mm = 0, height_mm = 0;
  double board_x_mm = 0, board_y_mm = 0;  ///< of the board's frame on the page
  double left_mm = 0, footer_mm = 0;
};

Layout MakeLayout(const std::vector<PrintShape>& shapes, const PrintPage& page) {
  Eigen::AlignedBox2d box;
  for (const PrintShape& shape : shapes) {
    const Eigen::Vector2d size(shape.width_mm, shape.height_mm);
    const Eigen::Vector2d corner =
        Eigen::Vector2d(shape.x_mm, shape.y_mm) - (shape.circle ? 0.5 : 0.0) * size;
    box.extend(corner).extend(corner + size);
  }
  const double width_mm = std::max(box.sizes().x(), kBarMm) + 2 * page.margin_mm;
  const double height_mm = box.sizes().y() + 2 * page.margin_mm + kFooterMm;
  Layout layout;
  layout.width_mm = page.width_mm > 0 ? page.width_mm : width_mm;
  layout.height_mm = page.height_mm > 0 ? page.height_mm : height_mm;
  if (layout.width_mm < width_mm || layout.height_mm < height_mm) {
    throw std::invalid_argument(
        fmt::format("the board needs a page of {:.0f} × {:.0f} mm, this one has {:.0f} × {:.0f}",
                    width_mm, height_mm, layout.width_mm, layout.height_mm));
  }
  layout.left_mm = page.margin_mm;
  layout.board_x_mm = page.margin_mm - box.min().x();
  layout.board_y_mm = page.margin_mm - box.min().y();
  layout.footer_mm = 2 * page.margin_mm + box.sizes().y();
  return layout;
}

/// Draws all shapes in order; rectangles of one colour in a row as one path, so that no hairline
/// stands between neighbours.
std::string Draw(const std::vector<PrintShape>& shapes) {
  std::string svg;
  const auto fill = [](const PrintShape& shape) { return shape.black ? "#000" : "#fff"; };
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const PrintShape& shape = shapes[i];
    if (shape.circle) {
      svg += fmt::format("<circle cx=\"{:.4f}\" cy=\"{:.4f}\" r=\"{:.4f}\" fill=\"{}\"/>\n",
                         shape.x_mm, shape.y_mm, shape.width_mm / 2, fill(shape));
      continue;
    }
    const bool starts = i == 0 || shapes[i - 1].circle || shapes[i - 1].black != shape.black;
    const bool ends =
        i + 1 == shapes.size() || shapes[i + 1].circle || shapes[i + 1].black != shape.black;
    if (starts) svg += fmt::format("<path fill=\"{}\" d=\"", fill(shape));
    svg += fmt::format("M{:.4f} {:.4f}h{:.4f}v{:.4f}h{:.4f}z", shape.x_mm, shape.y_mm,
                       shape.width_mm, shape.height_mm, -shape.width_mm);
    if (ends) svg += "\"/>\n";
  }
  return svg;
}

/// Writes the parameters as frame.yaml spells them.
std::string Describe(const Target& target) {
  switch (target.type) {
    case TargetType::kAprilTagGrid:
      return fmt::format(
          "type: apriltag_grid, family: {}, rows: {}, cols: {}, tag_size_mm: {:g}, "
          "tag_spacing_mm: {:g}, first_id: {}",
          target.family, target.rows, target.cols, target.tag_size_mm, target.tag_spacing_mm,
          target.first_id);
    case TargetType::kChessboard:
      return fmt::format("type: chessboard, rows: {}, cols: {}, spacing_mm: {:g}", target.rows,
                         target.cols, target.spacing_mm);
    default:
      return fmt::format(
          "type: circle_grid, rows: {}, cols: {}, spacing_mm: {:g}, asymmetric: {}, circles of "
          "{:g} mm",
          target.rows, target.cols, target.spacing_mm, target.asymmetric, target.ball_diameter_mm);
  }
}

/// Letters are as large as lets the text end on the page (a letter is 0.6 of its size wide).
std::string TextElement(const Layout& layout, double y_mm, const std::string& text) {
  const double room_mm = layout.width_mm - 2 * layout.left_mm;
  const double size_mm = std::min(kTextMm, room_mm / (0.6 * static_cast<double>(text.size())));
  return fmt::format(
      "<text x=\"{:g}\" y=\"{:g}\" font-family=\"monospace\" font-size=\"{:.3f}\">"
      "{}</text>\n",
      layout.left_mm, y_mm, size_mm, text);
}

std::string Footer(const Target& target, const Layout& layout) {
  const double text_mm = layout.footer_mm + kBarHeightMm + 1.5 * kTextMm;
  return fmt::format(
             "<rect id=\"bar_100_mm\" x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\" "
             "fill=\"#000\"/>\n",
             layout.left_mm, layout.footer_mm, kBarMm, kBarHeightMm) +
         TextElement(layout, text_mm,
                     "Print at 100 %; measure the bar: 100 mm. If not, print again.") +
         TextElement(layout, text_mm + 1.5 * kTextMm, Describe(target));
}

}  // namespace

std::string TargetSvg(const Target& target, const PrintPage& page) {
  const std::vector<PrintShape> shapes = TargetShapes(target);
  const Layout layout = MakeLayout(shapes, page);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}mm\" height=\"{1:g}mm\" "
      "viewBox=\"0 0 {0:g} {1:g}\">\n<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#fff\"/>\n"
      "<g id=\"board\" transform=\"translate({2:.4f} {3:.4f})\">\n",
      layout.width_mm, layout.height_mm, layout.board_x_mm, layout.board_y_mm);
  return svg + Draw(shapes) + "</g>\n" + Footer(target, layout) + "</svg>\n";
}

}  // namespace stereomotion
