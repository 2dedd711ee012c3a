// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_track.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/registries.hpp"
#include "core/error.hpp"
#include "exporters/track_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/track_score.hpp"

namespace waymark {
namespace {

struct Truth {
  std::vector<StampedPose> poses;
  bool headings = true;
};

Truth truth_of(const std::string& file, const TrackEvaluation& how) {
  if (file.ends_with(".csv")) {
    Truth truth;
    for (const TrackRow& row : read_track_csv(file).rows) truth.poses.push_back({row.t, row.at.pose});
    return truth;
  }
  const RobotLog log = import_log(file, all_types(), {.format = how.log_format, .robot = how.robot});
  Truth truth{log.truth, false};
  for (const StampedPose& p : log.truth) truth.headings = truth.headings || p.pose.yaw != 0;
  return truth;
}

}  // namespace

std::vector<Argument> track_arguments(TrackEvaluation& into) {
  return {Argument{"--align", "HOW", &into.align, "track: how it is laid over the truth first"}
              .one_of({"none", "se2", "sim2"})
              .or_else("none"),
          Argument{"--log-format", "FORMAT", &into.log_format, "track: format of a truth that is a log"}
              .one_of({"waymark", "mrclam", "victoria-park"})
              .or_else("recognised"),
          Argument{"--robot", "K", &into.robot, "track: which robot of an MRCLAM dataset is the truth"},
          Argument{"--longest-gap", "S", &into.longest_gap,
                   "track: seconds between two true poses that may be interpolated"}
              .or_else("0.5")};
}

std::string evaluate_track(const std::string& track_file, const std::string& truth_file,
                           const std::string& format, const TrackEvaluation& how) {
  const Track track = read_track_csv(track_file);
  const Truth truth = truth_of(truth_file, how);
  if (truth.poses.empty())
    throw Error(ErrorCode::input, "the truth has no poses", truth_file, "is it a log without true poses?");
  const TrackAlignment alignment = how.align == "se2"    ? TrackAlignment::se2
                                   : how.align == "sim2" ? TrackAlignment::sim2
                                                         : TrackAlignment::none;
  const TrackScore s = score(track, truth.poses, alignment, truth.headings, 1, how.longest_gap);
  if (s.poses == 0)
    throw Error(
        ErrorCode::input,
        fmt::format("track and truth have no time in common: {:.3f} to {:.3f} s and {:.3f} to {:.3f} s",
                    track.rows.empty() ? 0 : track.rows.front().t,
                    track.rows.empty() ? 0 : track.rows.back().t, truth.poses.front().t,
                    truth.poses.back().t),
        track_file, "are they of the same drive? a coarse truth needs a larger --longest-gap");
  nlohmann::ordered_json all;
  all["poses"] = s.poses;
  all["align"] = how.align;
  all["ate_rmse"] = s.ate_rmse;
  all["ate_median"] = s.ate_median;
  all["ate_largest"] = s.ate_largest;
  all["rpe"] = s.rpe;
  all["heading_rmse_deg"] = s.heading_rmse_deg ? nlohmann::ordered_json(*s.heading_rmse_deg) : nullptr;
  all["anees"] = s.anees ? nlohmann::ordered_json(*s.anees) : nullptr;
  all["anees_band"] = {s.anees_low, s.anees_high};
  all["matches"] = s.matches;
  all["rejected"] = s.rejected;
  all["wrong_matches"] = s.wrong_matches;
  all["lost"] = s.lost;
  all["time_per_update_us"] = nullptr;  // a track has no times: waymark localize says how long it took
  if (format == "json") return all.dump(2) + "\n";
  std::string text;
  for (const auto& [name, value] : all.items())
    text += fmt::format("{:20} {}\n", name,
                        value.is_number_float() ? fmt::format("{:.4g}", value.get<double>())
                        : value.is_null()       ? "not known"
                        : value.is_string()     ? value.get<std::string>()
                                                : value.dump());
  return text;
}

}  // namespace waymark
