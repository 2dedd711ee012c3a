// SPDX-License-Identifier: Apache-2.0
#include "workflows/evaluation/track_study.hpp"

#include <fmt/format.h>

#include <functional>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "exporters/report/error_bands_picture.hpp"

namespace waymark::workflows {
namespace {

using Measure = std::function<std::optional<double>(const localization::TrackScore&)>;

void add_row(TrackStudy& study, const std::string& name, const Measure& measure) {
  std::vector<double> values;
  for (const localization::TrackScore& drive : study.drives)
    if (const auto value = measure(drive)) values.push_back(*value);
  if (values.empty()) return;
  const std::size_t drives = values.size();
  study.rows.push_back({name, drives, localization::spread_over_drives(std::move(values))});
}

std::vector<TrackEvaluation> list_drives(const TrackEvaluation& first, const std::vector<std::string>& more) {
  TrackEvaluation common = first;
  common.picture = {};
  std::vector<TrackEvaluation> drives{common};
  for (const std::string& text : more) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
      throw Error(ErrorCode::usage, "--drive takes TRACK=TRUTH, is '" + text + "'", "",
                  "e.g. --drive ekf2.csv=drive2.jsonl");
    common.track = text.substr(0, equals), common.truth = text.substr(equals + 1);
    drives.push_back(common);
  }
  return drives;
}

void check_study(const TrackEvaluation& first) {
  if (!first.also.empty())
    throw Error(ErrorCode::usage, "--also and --drive exclude each other", "",
                "--also adds tracks of one drive to its picture, --drive adds drives");
  if (first.picture.empty()) return;
  if (!first.picture.ends_with(".svg"))
    throw Error(ErrorCode::usage, "a picture of tracks is written as .svg", first.picture);
  if (first.align != "none")
    throw Error(ErrorCode::usage, "errors over time are drawn without alignment", first.picture,
                "leave out --align or --picture");
}

}  // namespace

TrackStudy evaluate_drives(const TrackEvaluation& first, const std::vector<std::string>& more) {
  check_study(first);
  TrackStudy study;
  std::vector<std::vector<localization::TrackErrorAt>> errors;
  for (const TrackEvaluation& drive : list_drives(first, more)) {
    study.drives.push_back(evaluate(drive));
    if (!first.picture.empty()) errors.push_back(track_errors(drive));
  }
  using Score = localization::TrackScore;
  add_row(study, "ATE RMSE, m", [](const Score& s) { return s.ate_rmse; });
  add_row(study, "ATE median, m", [](const Score& s) { return s.ate_median; });
  add_row(study, "ATE largest, m", [](const Score& s) { return s.ate_largest; });
  add_row(study, "RPE, m", [](const Score& s) { return s.rpe; });
  add_row(study, "heading, deg", [](const Score& s) { return s.heading_rmse_deg; });
  add_row(study, "ANEES",
          [](const Score& s) { return s.consistency ? std::optional(s.consistency->anees) : std::nullopt; });
  add_row(study, "lost, %", [](const Score& s) { return 100 * s.lost; });
  add_row(study, "wrong, %", [](const Score& s) {
    return s.wrong_matches && s.matches > 0
               ? std::optional(100 * static_cast<double>(*s.wrong_matches) / static_cast<double>(s.matches))
               : std::nullopt;
  });
  for (const Score& s : study.drives) {
    if (!s.consistency) continue;
    ++study.with_covariances;
    study.consistent +=
        s.consistency->low <= s.consistency->anees && s.consistency->anees <= s.consistency->high;
  }
  if (!first.picture.empty())
    write_file(first.picture, exporters::error_bands_picture(fmt::format("{} drives", study.drives.size()),
                                                             localization::error_bands(errors)));
  return study;
}

}  // namespace waymark::workflows
