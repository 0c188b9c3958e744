#include <fmt/format.h>

#include <cmath>
#include <map>

#include "report_sections.h"
#include "report_text.h"
#include "stereomotion/core/units.h"
#include "stereomotion/geometry/so3.h"

namespace stereomotion {
namespace {

struct Row {
  const char* name;
  const char* unit;
  double value;
  double scale;  // of value and σ, to the unit shown
};

// The fifteen parameters of a camera in the order of `RigParameter`, as people read them.
std::vector<Row> RowsOf(const RigCamera& camera) {
  const CameraModel& m = camera.model;
  const Eigen::Vector3d turn = LogSO3(camera.cam_from_world.rotation);
  const Eigen::Vector3d& t = camera.cam_from_world.translation_mm;
  return {{"f<sub>x</sub>", "px", m.fx_px, 1},
          {"f<sub>y</sub>", "px", m.fy_px, 1},
          {"c<sub>x</sub>", "px", m.cx_px, 1},
          {"c<sub>y</sub>", "px", m.cy_px, 1},
          {"k<sub>1</sub>", "", m.k1, 1},
          {"k<sub>2</sub>", "", m.k2, 1},
          {"p<sub>1</sub>", "", m.p1, 1},
          {"p<sub>2</sub>", "", m.p2, 1},
          {"k<sub>3</sub>", "", m.k3, 1},
          {"rotation x", "°", turn.x(), kDegreesPerRadian},
          {"rotation y", "°", turn.y(), kDegreesPerRadian},
          {"rotation z", "°", turn.z(), kDegreesPerRadian},
          {"translation x", "mm", t.x(), 1},
          {"translation y", "mm", t.y(), 1},
          {"translation z", "mm", t.z(), 1}};
}

// Standard uncertainties by camera and index.
std::map<std::pair<int, int>, double> SigmaByParameter(const Rig& rig) {
  std::map<std::pair<int, int>, double> sigmas;
  if (!rig.covariance) return sigmas;
  const ParameterSpread spread = SpreadOfParameters(rig);
  for (std::size_t i = 0; i < spread.names.size(); ++i) {
    const RigParameter& parameter = rig.covariance->parameters[i];
    sigmas[{parameter.camera, parameter.index}] = spread.sigma[static_cast<Eigen::Index>(i)];
  }
  return sigmas;
}

std::string PositionSentence(const RigCamera& camera) {
  const Eigen::Vector3d center = camera.cam_from_world.Inverse().translation_mm;
  constexpr double kShown_mm = 1;  // one decimal more than this
  const auto place = [&](int i) { return ValueText(center[i], kShown_mm); };
  return fmt::format("{} stands at ({}, {}, {}) mm in the world", EscapeHtml(camera.name), place(0),
                     place(1), place(2));
}

std::string PositionsParagraph(const Rig& rig) {
  std::string text = "<p>";
  for (const RigCamera& camera : rig.cameras) text += PositionSentence(camera) + "; ";
  text.resize(text.size() - 2);
  const auto position = [&](std::size_t i) {
    return rig.cameras[i].cam_from_world.Inverse().translation_mm;
  };
  if (rig.cameras.size() == 2) {
    text += fmt::format("; the base between them is {:.1f} mm long",
                        (position(1) - position(0)).norm());
  }
  return text + ".</p>\n";
}

}  // namespace

std::string ParametersSection(const ReportData& data) {
  const Rig& rig = data.calibration.rig;
  const auto sigmas = SigmaByParameter(rig);
  std::string columns = "ll";
  std::vector<std::string> heads = {"", ""};
  for (const RigCamera& camera : rig.cameras) {
    columns += "rr";
    heads.push_back(EscapeHtml(camera.name));
    heads.emplace_back("σ");
  }
  HtmlTable table(columns, heads);
  for (int i = 0; i < RigParameter::kPerCamera; ++i) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      const Row row = RowsOf(rig.cameras[c])[i];
      if (cells.empty()) cells = {row.name, row.unit};
      const auto found = sigmas.find({static_cast<int>(c), i});
      const double sigma = found == sigmas.end() ? 0 : found->second * row.scale;
      cells.push_back(ValueText(row.value * row.scale, sigma));
      cells.push_back(found == sigmas.end() ? "<i>fixed</i>" : Digits(sigma, 2));
    }
    table.AddRow(cells);
  }
  return "<section><h2>Parameters</h2>\n" + table.Text() + PositionsParagraph(rig) +
         "<p class=\"small\">σ: standard uncertainty from image noise and survey together. "
         "Rotation: "
         "vector of <code>cam_from_world</code>; its σ is a turn about the camera's axes.</p>\n"
         "</section>\n";
}

}  // namespace stereomotion
