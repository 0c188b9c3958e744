#include "bench/accuracy_condition.h"

namespace stereomotion::bench {
namespace {

/// Sweeps one member of the condition over `values`.
void AppendSweep(const Condition& base, double Condition::*varied,
                 const std::vector<double>& values, std::vector<Condition>& conditions) {
  for (const double value : values) {
    Condition condition = base;
    condition.*varied = value;
    conditions.push_back(condition);
  }
}

Condition Named(const std::string& sweep, double diameter_px, double snr_db) {
  Condition condition;
  condition.sweep = sweep;
  condition.diameter_px = diameter_px;
  condition.snr_db = snr_db;
  return condition;
}

std::vector<Condition> FullStudy() {
  std::vector<Condition> all;
  AppendSweep(Named("snr", 9, 0), &Condition::snr_db, {40, 35, 30, 25, 20, 15, 10}, all);
  AppendSweep(Named("diameter", 0, 30), &Condition::diameter_px, {6, 7.5, 9, 12, 16, 20, 25, 30},
              all);
  for (const double snr_db : {40, 30, 20, 15, 10}) {
    AppendSweep(Named("grid", 0, snr_db), &Condition::diameter_px, {6, 10, 14, 20, 30}, all);
  }
  for (const double snr_db : {40, 25}) {
    AppendSweep(Named("smear", 9, snr_db), &Condition::smear_diameters, {0, 0.25, 0.5, 1, 1.5, 2},
                all);
  }
  AppendSweep(Named("hidden", 12, 40), &Condition::hidden_fraction, {0, 0.1, 0.2, 0.3, 0.4, 0.5},
              all);
  Condition phase = Named("phase", 6, 40);
  phase.balls = 5000;
  phase.each_phase = true;
  all.push_back(phase);
  Condition histogram = Named("histogram", 9, 30);
  histogram.balls = 20000;
  histogram.keeps_errors = true;
  all.push_back(histogram);
  return all;
}

}  // namespace

std::vector<Condition> StudyConditions(bool quick) {
  std::vector<Condition> conditions;
  for (Condition condition : FullStudy()) {
    const bool same_sweep = !conditions.empty() && conditions.back().sweep == condition.sweep;
    if (quick && same_sweep) continue;
    if (quick) condition.balls = condition.each_phase ? 2 : 100;
    if (quick && condition.sweep == "smear") condition.smear_diameters = 1;
    if (quick && condition.sweep == "hidden") condition.hidden_fraction = 0.2;
    conditions.push_back(condition);
  }
  return conditions;
}

}  // namespace stereomotion::bench
