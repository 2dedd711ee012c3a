// SPDX-License-Identifier: Apache-2.0
#include "apps/score_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace waymark::apps {
namespace {

using nlohmann::json;

std::string number(double value, int digits = 3) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}
std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : "-";
}
json finite(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

std::string counts_line(const std::string& what, const testbed::ScoreCounts& c) {
  return fmt::format("{:<14} {:>8} {:>8} {:>8} {:>10} {:>8} {:>8}\n", what, c.truth, c.found, c.matched,
                     number(c.precision()), number(c.recall()), number(c.f1()));
}

std::string as_text(const testbed::Score& s) {
  std::string text = fmt::format("{:<14} {:>8} {:>8} {:>8} {:>10} {:>8} {:>8}\n", "diameter", "truth",
                                 "found", "matched", "precision", "recall", "F1");
  for (const testbed::ScoreCounts& bin : s.by_size)
    text += counts_line(
        fmt::format("{:g} - {}", bin.from, std::isfinite(bin.to) ? fmt::format("{:g}", bin.to) : ""), bin);
  text += counts_line("all", s.all);
  if (std::isfinite(s.average_precision)) text += "average precision " + number(s.average_precision) + "\n";
  text += fmt::format("found twice {}\n", s.duplicates);
  text += fmt::format("position error: median {}, 90 % {}, RMS {}; median {} of the diameter\n",
                      number(s.position_median), number(s.position_p90), number(s.position_rmse),
                      percent(s.relative_position_median));
  if (s.with_covariance)
    text += fmt::format("inside the 90 % ellipse {} of {}; NEES {}, median {} (consistent: 2, 1.39)\n",
                        percent(s.inside_90), s.with_covariance, number(s.nees, 2), number(s.nees_median, 2));
  for (const auto& [name, e] : s.features) {
    text += std::isfinite(e.relative_bias)
                ? fmt::format("{}: bias {} ({}), spread {}, median error {}, n = {}\n", name, number(e.bias),
                              percent(e.relative_bias), percent(e.relative_sd), number(e.absolute), e.count)
                : fmt::format("{}: bias {}, median error {}, n = {}\n", name, number(e.bias),
                              number(e.absolute), e.count);
    if (e.with_deviation)
      text += fmt::format("  inside the 90 % interval {} of {}\n", percent(e.inside_90), e.with_deviation);
  }
  const auto calibration = [&](const char* what, const std::vector<testbed::CalibrationBin>& bins,
                               double error) {
    if (bins.empty()) return;
    text += fmt::format("{}: calibration error {}\n", what, number(error));
    for (const testbed::CalibrationBin& bin : bins)
      text += fmt::format("  {:.1f} - {:.1f}: {} of {} right, {} claimed\n", bin.from, bin.to, bin.right,
                          bin.found, number(bin.mean));
  };
  calibration("confidence", s.by_confidence, s.confidence_error);
  calibration("quality", s.by_quality, s.quality_error);
  return text;
}

json as_json(const testbed::ScoreCounts& c) {
  return {{"truth", c.truth},
          {"found", c.found},
          {"matched", c.matched},
          {"precision", finite(c.precision())},
          {"recall", finite(c.recall())},
          {"f1", finite(c.f1())}};
}

json as_json(const std::vector<testbed::CalibrationBin>& bins) {
  json all = json::array();
  for (const testbed::CalibrationBin& b : bins)
    all.push_back(
        {{"from", b.from}, {"to", b.to}, {"claimed", b.mean}, {"found", b.found}, {"right", b.right}});
  return all;
}

json as_json(const testbed::Score& s) {
  json object = as_json(s.all);
  object["average_precision"] = finite(s.average_precision);
  object["found_twice"] = s.duplicates;
  object["position_median"] = finite(s.position_median);
  object["position_p90"] = finite(s.position_p90);
  object["position_rmse"] = finite(s.position_rmse);
  object["position_median_of_diameter"] = finite(s.relative_position_median);
  object["inside_90"] = finite(s.inside_90);
  object["nees"] = finite(s.nees);
  object["nees_median"] = finite(s.nees_median);
  object["by_size"] = json::array();
  for (const testbed::ScoreCounts& bin : s.by_size) {
    json one = as_json(bin);
    one["from"] = bin.from, one["to"] = finite(bin.to);
    object["by_size"].push_back(one);
  }
  for (const auto& [name, e] : s.features)
    object["features"][name] = {{"count", e.count},
                                {"bias", finite(e.bias)},
                                {"relative_bias", finite(e.relative_bias)},
                                {"relative_sd", finite(e.relative_sd)},
                                {"median_error", finite(e.absolute)},
                                {"inside_90", finite(e.inside_90)},
                                {"with_deviation", e.with_deviation}};
  if (!s.by_confidence.empty())
    object["confidence"] = {{"calibration_error", s.confidence_error}, {"bins", as_json(s.by_confidence)}};
  if (!s.by_quality.empty())
    object["quality"] = {{"calibration_error", s.quality_error}, {"bins", as_json(s.by_quality)}};
  return object;
}

nlohmann::ordered_json as_json(const localization::TrackScore& s, const std::string& align) {
  nlohmann::ordered_json all;
  all["poses"] = s.poses;
  all["align"] = align;
  all["ate_rmse"] = s.ate_rmse;
  all["ate_median"] = s.ate_median;
  all["ate_largest"] = s.ate_largest;
  all["rpe"] = s.rpe;
  all["heading_rmse_deg"] = s.heading_rmse_deg ? nlohmann::ordered_json(*s.heading_rmse_deg) : nullptr;
  const auto& c = s.consistency;
  all["anees"] = c ? nlohmann::ordered_json(c->anees) : nullptr;
  all["anees_band"] = c ? nlohmann::ordered_json{c->low, c->high} : nullptr;
  all["anees_independent"] = c ? nlohmann::ordered_json(c->independent) : nullptr;
  const auto& v = s.innovations;
  all["anis"] = v ? nlohmann::ordered_json(v->anees) : nullptr;
  all["anis_band"] = v ? nlohmann::ordered_json{v->low, v->high} : nullptr;
  all["matches"] = s.matches;
  all["rejected"] = s.rejected;
  all["wrong_matches"] = s.wrong_matches ? nlohmann::ordered_json(*s.wrong_matches) : nullptr;
  all["lost"] = s.lost;
  // Known if `waymark localize` ran with --timing.
  all["time_per_update_us"] = s.update_seconds ? nlohmann::ordered_json(1e6 * *s.update_seconds) : nullptr;
  return all;
}

}  // namespace

std::string scores_as_text(const std::map<std::string, testbed::Score>& scores) {
  std::string text;
  for (const auto& [type, s] : scores) text += (text.empty() ? "" : "\n") + type + "\n" + as_text(s);
  return text;
}

std::string scores_as_json(const std::map<std::string, testbed::Score>& scores) {
  json all = json::object();
  for (const auto& [type, s] : scores) all[type] = as_json(s);
  return all.dump(2) + "\n";
}

std::string track_score_as_json(const localization::TrackScore& score, const std::string& align) {
  return as_json(score, align).dump(2) + "\n";
}

std::string track_study_as_json(const workflows::TrackStudy& study, const std::string& align) {
  json rows = json::object();
  for (const workflows::StudyRow& row : study.rows)
    rows[row.name] = {{"drives", row.drives},    {"median", row.spread.median}, {"low", row.spread.low},
                      {"high", row.spread.high}, {"min", row.spread.min},       {"max", row.spread.max}};
  nlohmann::ordered_json all{{"drives", study.drives.size()},
                             {"consistent", study.consistent},
                             {"with_covariances", study.with_covariances},
                             {"summary", rows},
                             {"scores", nlohmann::ordered_json::array()}};
  for (const localization::TrackScore& score : study.drives) all["scores"].push_back(as_json(score, align));
  return all.dump(2) + "\n";
}

std::string track_study_as_text(const workflows::TrackStudy& study, const std::string&) {
  std::string text = fmt::format("{:<16} {:>7} {:>9} {:>20} {:>9} {:>9}\n", "", "drives", "median",
                                 "95 % interval", "best", "worst");
  for (const workflows::StudyRow& row : study.rows)
    text += fmt::format("{:<16} {:>7} {:>9} {:>20} {:>9} {:>9}\n", row.name, row.drives,
                        number(row.spread.median),
                        fmt::format("{} to {}", number(row.spread.low), number(row.spread.high)),
                        number(row.spread.min), number(row.spread.max));
  return text + fmt::format("consistent: {} of {} drives with covariances have ANEES inside its band\n",
                            study.consistent, study.with_covariances);
}

std::string track_score_as_text(const localization::TrackScore& score, const std::string& align) {
  const nlohmann::ordered_json all = as_json(score, align);
  std::string text;
  for (const auto& [name, value] : all.items())
    text += fmt::format("{:20} {}\n", name,
                        value.is_number_float() ? fmt::format("{:.4g}", value.get<double>())
                        : value.is_null()       ? "not known"
                        : value.is_string()     ? value.get<std::string>()
                                                : value.dump());
  return text;
}

}  // namespace waymark::apps
