// Compares edge operators on the step edge of a CCD. Writes DIR/edge_snr.csv and
// DIR/edge_localisation.csv, prints both as Markdown.
//
// All responses are gradients in DN/px (a product of two scales enters by its square root), so one
// measure serves all. Signal-to-noise ratio, scored in two ways: 20 log10(mean response within half
// a pixel of the true edge / RMS response further than 12 px from it); and, on the footing of
// detection, 20 log10((mean at the edge − mean away) / standard deviation away), where a response
// that is clipped at zero gains nothing by its clipping. Localisation: maxima along the gradient
// above half the mean response at the edge, by one finder for all. In each stretch of 1 px of the
// edge the clearest maximum within 2 px counts: RMS distance from the true edge; stretches without
// one are missed; maxima further off are false. A second block, not comparable with the others, has
// the detector's own refinement of the wavelets' maxima.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/edge_operators.h"
#include "bench/edge_scene.h"
#include "bench/edge_score.h"

namespace stereomotion::bench {
namespace {

/// Judges one operator; the same noise for all. The threshold of its maxima is half its mean
/// response at the edge.
Score Judge(const EdgeOperator& op, const Condition& condition) {
  constexpr std::uint64_t kSeed = 20261122;
  Score score;
  std::vector<EdgeResponse> responses;
  std::mt19937_64 rng(kSeed);
  for (int k = 0; k < kEdges; ++k) {
    responses.push_back(op.apply(ExposeEdge(EdgeAt(k), condition, rng)));
    ScoreResponse(responses.back(), EdgeAt(k), score);
  }
  const double threshold = 0.5 * score.MeanAtEdge();
  for (int k = 0; k < kEdges; ++k) {
    const EdgeResponse& response = responses[static_cast<std::size_t>(k)];
    std::vector<EdgeMaximum> maxima = FindMaxima(response, threshold);
    ScoreMaxima(maxima, EdgeAt(k), score.common);
    Refine(response, maxima);
    ScoreMaxima(maxima, EdgeAt(k), score.refined);
  }
  return score;
}

struct Tables {
  std::string snr_csv = "light_dn,noise_dn,operator,snr_db\n";
  std::string localisation_csv =
      "light_dn,noise_dn,operator,rms_px,missed_percent,false_per_edge_px\n";
  std::string snr, detection_snr, localisation, refined;   ///< Markdown
  std::map<std::string, std::map<std::string, int>> wins;  ///< by measure and operator
};

void AddRow(const Condition& condition, const std::vector<EdgeOperator>& operators,
            Tables& tables) {
  const std::string head = fmt::format("| {} | {} |", condition.light_dn, condition.noise_dn);
  for (std::string* table : {&tables.snr, &tables.detection_snr, &tables.localisation}) {
    *table += head;
  }
  std::map<std::string, std::pair<double, std::string>> best;
  const auto compare = [&](const std::string& measure, double loss, const std::string& name) {
    const auto [at, is_new] = best.try_emplace(measure, loss, name);
    if (!is_new && loss < at->second.first) at->second = {loss, name};
  };
  for (const EdgeOperator& op : operators) {
    const Score score = Judge(op, condition);
    const LocalisationScore& common = score.common;
    tables.snr += fmt::format(" {:.1f} |", score.SnrDb());
    tables.detection_snr += fmt::format(" {:.1f} |", score.DetectionSnrDb());
    tables.localisation += common.Cell();
    if (op.name == kDetectorScales) tables.refined += head + score.refined.Cell() + "\n";
    compare("signal-to-noise ratio", -score.SnrDb(), op.name);
    compare("detection signal-to-noise ratio", -score.DetectionSnrDb(), op.name);
    compare("localisation", common.RmsPx(), op.name);
    tables.snr_csv += fmt::format("{},{},{},{:.3f}\n", condition.light_dn, condition.noise_dn,
                                  op.name, score.SnrDb());
    tables.localisation_csv +=
        fmt::format("{},{},{},{:.4f},{:.2f},{:.4f}\n", condition.light_dn, condition.noise_dn,
                    op.name, common.RmsPx(), common.MissedPercent(), common.FalsePerPx());
  }
  for (std::string* table : {&tables.snr, &tables.detection_snr, &tables.localisation}) {
    *table += "\n";
  }
  for (const auto& [measure, winner] : best) ++tables.wins[measure][winner.second];
}

/// Says which operator is best in how many of the conditions.
std::string WhatWins(const Tables& tables) {
  std::string text;
  for (const auto& [measure, winners] : tables.wins) {
    text += fmt::format("Best {}, conditions out of 12:", measure);
    for (const auto& [name, count] : winners) text += fmt::format(" {} {}", name, count);
    text += ".\n";
  }
  return text;
}

std::string Header(const std::vector<EdgeOperator>& operators) {
  std::string names = "| light DN | noise σ DN |";
  std::string rule = "|---|---|";
  for (const EdgeOperator& op : operators) {
    names += " " + op.name + " |";
    rule += "---|";
  }
  return names + "\n" + rule + "\n";
}

Tables Study() {
  const std::vector<EdgeOperator> operators = AllEdgeOperators();
  Tables tables;
  tables.snr = tables.detection_snr = tables.localisation = Header(operators);
  tables.refined = fmt::format("| light DN | noise σ DN | {} |\n|---|---|---|\n", kDetectorScales);
  for (const double light_dn : {1000.0, 500.0, 250.0}) {  // steps of 50, 25 and 12.5 DN
    for (const double noise_dn : {1.0, 2.0, 4.0, 6.0}) {
      AddRow({light_dn, noise_dn}, operators, tables);
    }
  }
  return tables;
}

void Write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void Print(const Tables& tables) {
  fmt::print(
      "Signal-to-noise ratio, dB: mean at the edge / RMS away\n\n{}\n"
      "Detection signal-to-noise ratio, dB: (mean at the edge − mean away) / standard deviation "
      "away\n\n{}\n"
      "Localisation, one finder for all: RMS distance px / missed % / false maxima per px of "
      "edge\n\n{}\n"
      "Localisation with the detector's own refinement, the wavelets only\n\n{}\n{}",
      tables.snr, tables.detection_snr, tables.localisation, tables.refined, WhatWins(tables));
}

}  // namespace
}  // namespace stereomotion::bench

int main(int argc, char** argv) {
  namespace bench = stereomotion::bench;
  const bool has_output = argc == 3 && std::strcmp(argv[1], "--output") == 0;
  if (argc != 1 && !has_output) {
    fmt::print(stderr, "usage: stereomotion_edge_study [--output DIR]\n");
    return 2;
  }
  try {
    const bench::Tables tables = bench::Study();
    if (has_output) {
      std::filesystem::create_directories(argv[2]);
      bench::Write(std::filesystem::path(argv[2]) / "edge_snr.csv", tables.snr_csv);
      bench::Write(std::filesystem::path(argv[2]) / "edge_localisation.csv",
                   tables.localisation_csv);
    }
    bench::Print(tables);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
