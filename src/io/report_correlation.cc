#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "report_color.h"
#include "report_sections.h"
#include "report_text.h"
#include "svg_plot.h"

namespace stereomotion {
namespace {

constexpr double kStrong = 0.9;        // |correlation| from which a pair is named
constexpr std::size_t kMostPairs = 3;  // of one meaning
constexpr int kMostDirections = 3;

struct Pair {
  Eigen::Index a, b;
  double correlation;
};

std::vector<Pair> StrongPairs(const Eigen::MatrixXd& correlation) {
  std::vector<Pair> pairs;
  for (Eigen::Index a = 0; a < correlation.rows(); ++a) {
    for (Eigen::Index b = a + 1; b < correlation.cols(); ++b) {
      if (std::abs(correlation(a, b)) >= kStrong) pairs.push_back({a, b, correlation(a, b)});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
    return std::abs(x.correlation) > std::abs(y.correlation);
  });
  return pairs;
}

// What the parameters do to the image, by their index in `RigParameter`.
enum class Kind { kFocal, kPrincipal, kRadial, kTangential, kRotation, kSideways, kDistance };

Kind KindOf(int index) {
  if (index < 2) return Kind::kFocal;
  if (index < 4) return Kind::kPrincipal;
  if (index == 6 || index == 7) return Kind::kTangential;
  if (index < 9) return Kind::kRadial;
  if (index < 12) return Kind::kRotation;
  return index == RigParameter::kPerCamera - 1 ? Kind::kDistance : Kind::kSideways;
}

std::string Meaning(const RigParameter& a, const RigParameter& b) {
  const auto is = [&](Kind x, Kind y) {
    const Kind first = KindOf(a.index), second = KindOf(b.index);
    return (first == x && second == y) || (first == y && second == x);
  };
  if (a.camera != b.camera) return "the cameras change together";
  if (is(Kind::kFocal, Kind::kFocal)) return "one focal length; usual with square pixels";
  if (is(Kind::kFocal, Kind::kDistance)) {
    return "focal length and distance are hardly separable; add depth or tilt";
  }
  if (is(Kind::kPrincipal, Kind::kRotation) || is(Kind::kPrincipal, Kind::kSideways)) {
    return "a shifted principal point looks like a turned or shifted camera; tilt and depth "
           "separate them";
  }
  if (is(Kind::kPrincipal, Kind::kTangential)) {
    return "principal point and tangential distortion replace each other; harmless";
  }
  if (is(Kind::kRadial, Kind::kRadial)) {
    return "terms of one distortion curve; harmless inside the image";
  }
  if (is(Kind::kRotation, Kind::kSideways)) {
    return "turning and shifting the camera look alike from the target; harmless near it";
  }
  return "";
}

std::string CorrelationText(double correlation) {
  constexpr double kAlmostOne = 0.9995;  // would be rounded to 1
  if (std::abs(correlation) < kAlmostOne) return fmt::format("{:.3f}", correlation);
  return correlation > 0 ? "&gt;0.999" : "&lt;-0.999";
}

std::string GroupSentence(const ParameterSpread& spread, const std::string& meaning,
                          const std::vector<Pair>& members) {
  std::string text = "<li>" + (meaning.empty() ? "others" : meaning) + ":";
  for (std::size_t i = 0; i < std::min(kMostPairs, members.size()); ++i) {
    text +=
        fmt::format("{} <code>{}</code> – <code>{}</code> ({})", i > 0 ? "," : "",
                    EscapeHtml(spread.names[members[i].a]), EscapeHtml(spread.names[members[i].b]),
                    CorrelationText(members[i].correlation));
  }
  if (members.size() > kMostPairs) text += fmt::format(" and {} more", members.size() - kMostPairs);
  return text + "</li>\n";
}

std::string PairSentences(const ReportData& data, const ParameterSpread& spread) {
  const auto pairs = StrongPairs(spread.correlation);
  if (pairs.empty()) {
    return fmt::format("<p>No two parameters are correlated by more than {}.</p>\n", kStrong);
  }
  const auto& parameters = data.calibration.rig.covariance->parameters;
  // What means the same stands together, the strongest first.
  std::vector<std::pair<std::string, std::vector<Pair>>> groups;
  for (const Pair& pair : pairs) {
    const std::string meaning = Meaning(parameters[pair.a], parameters[pair.b]);
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const auto& g) { return g.first == meaning; });
    if (group == groups.end()) group = groups.insert(groups.end(), {meaning, {}});
    group->second.push_back(pair);
  }
  std::string text =
      fmt::format("<p>{} pairs of parameters are correlated by {} and more:</p>\n<ul>\n",
                  pairs.size(), kStrong);
  for (const auto& [meaning, members] : groups) text += GroupSentence(spread, meaning, members);
  return text + "</ul>\n";
}

std::string NameDirection(const ParameterSpread& spread, const Eigen::VectorXd& direction) {
  constexpr double kPart = 0.5;  // of the largest component: what a person calls part of it
  constexpr int kMostNames = 6;
  std::vector<int> order(static_cast<std::size_t>(direction.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  std::string text;
  for (int k = 0; k < std::min<int>(kMostNames, static_cast<int>(order.size())); ++k) {
    const double part = direction[order[k]] / direction[order[0]];  // the first one counts up
    if (std::abs(part) < kPart) break;
    text += fmt::format("{}<code>{}</code>{}", k > 0 ? ", " : "",
                        EscapeHtml(spread.names[order[k]]), part > 0 ? " ↑" : " ↓");
  }
  return text;
}

std::string DirectionSentences(const ParameterSpread& spread) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(spread.correlation);
  std::string text =
      "<p>Weak directions: what can change together with the least change of the images, in units "
      "of each parameter's σ.</p>\n<ol>\n";
  for (Eigen::Index k = 0; k < std::min<Eigen::Index>(kMostDirections, spread.sigma.size()); ++k) {
    const Eigen::Index column = spread.sigma.size() - 1 - k;
    const double stretch = std::sqrt(std::max(0.0, solver.eigenvalues()[column]));
    text +=
        fmt::format("<li>{}: together {} times as uncertain as if they were independent</li>\n",
                    NameDirection(spread, solver.eigenvectors().col(column)), Digits(stretch, 2));
  }
  return text + "</ol>\n";
}

std::string HeatMap(const ParameterSpread& spread) {
  constexpr double kSide = 510, kLabels = 92, kBar = 94, kMaxCell = 24;
  const int n = static_cast<int>(spread.names.size());
  const double cell = std::min(kMaxCell, kSide / n);
  const double side = cell * n;
  std::string drawing;
  for (int i = 0; i < n; ++i) {
    const double y = (i + 0.5) * cell + 4;
    const auto size =
        fmt::format("style=\"font-size:{}px\"", Px(std::clamp(cell * 0.75, 5.0, 11.0)));
    drawing += SvgText(kLabels - 5, y, "end", spread.names[i], size);
    drawing += SvgText(kLabels + (i + 0.5) * cell + 4, side + 8, "end", spread.names[i],
                       size + fmt::format(" transform=\"rotate(-90 {} {})\"",
                                          Px(kLabels + (i + 0.5) * cell + 4), Px(side + 8)));
    for (int j = 0; j <= i; ++j) {
      const double r = spread.correlation(i, j);
      drawing += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"><title>{} {}: "
          "{:.3f}</title></rect>\n",
          Px(kLabels + j * cell), Px(i * cell), Px(cell), Px(cell), DivergingColor(r),
          EscapeHtml(spread.names[i]), EscapeHtml(spread.names[j]), std::isfinite(r) ? r : 0);
    }
  }
  drawing += ColorBar({kLabels + side + 14, side * 0.1, 14, side * 0.8}, {-1, 1}, "correlation",
                      DivergingColor);
  return Figure(kLabels + side + kBar, side + kLabels + 8, "Correlations of the parameters",
                drawing, "Correlation of the estimated parameters, −1 (blue) to 1 (orange).");
}

}  // namespace

std::string CorrelationSection(const ReportData& data) {
  const ParameterSpread spread = SpreadOfParameters(data.calibration.rig);
  if (spread.names.empty()) return "";
  return "<section><h2>What the images hardly tell apart</h2>\n" + PairSentences(data, spread) +
         DirectionSentences(spread) + HeatMap(spread) + "</section>\n";
}

}  // namespace stereomotion
