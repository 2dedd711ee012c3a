// SPDX-License-Identifier: Apache-2.0
#include "apps/evaluate_track.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/registries.hpp"
#include "apps/robot_map.hpp"
#include "core/error.hpp"
#include "exporters/aside_folder.hpp"
#include "exporters/track_file.hpp"
#include "exporters/track_picture.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/harvested.hpp"
#include "localization/track_score.hpp"

namespace waymark {
namespace {

struct Truth {
  std::vector<StampedPose> poses;
  std::vector<FelledReading> felled;
  bool headings = true;
};

Truth truth_of(const std::string& file, const TrackEvaluation& how, const LocalFrame* frame) {
  if (file.ends_with(".csv")) {
    Truth truth;
    for (const TrackRow& row : read_track_csv(file).rows) truth.poses.push_back({row.t, row.at.pose});
    return truth;
  }
  RobotLog log = import_log(file, all_types(), {.format = how.log_format, .robot = how.robot});
  if (frame) place_in(log, *frame);
  Truth truth{log.truth, log.felled, false};
  for (const StampedPose& p : log.truth) truth.headings = truth.headings || p.pose.yaw != 0;
  return truth;
}

// Colours of the types' own symbols, paler so that tracks stand out.
std::vector<PictureDot> dots_of(OpenedMap& opened) {
  std::vector<PictureDot> dots;
  for (const MapLandmark& l : opened.window.around({0, 0}, 0).landmarks()) {
    const std::string type = opened.map.types()[l.type].name;
    const bool radius = type == "rock" || type == "crater";
    const double size = radius && l.features.known(0)           ? l.features.value[0]
                        : type == "tree" && l.features.known(1) ? l.features.value[1]
                                                                : 0.5;
    if (type == "crater") continue;  // wide discs would hide the rest
    dots.push_back({l.at, size, type == "tree" ? "#8fbc8f" : "#b5ada3"});
  }
  return dots;
}

void draw(const std::string& track_file, const Track& track, const Truth& truth, OpenedMap* opened,
          const TrackEvaluation& how) {
  if (!how.picture.ends_with(".svg"))
    throw Error(ErrorCode::usage, "a picture of tracks is written as .svg", how.picture);
  TrackPicture picture{.title = std::filesystem::path(track_file).stem(),
                       .map = {},
                       .truth = truth.poses,
                       .tracks = {},
                       .harvested = {}};
  if (opened) picture.map = dots_of(*opened);
  for (const std::string& more : how.also) {
    const std::size_t equals = more.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorCode::usage, "--also takes NAME=TRACK.csv, is '" + more + "'", "",
                  "e.g. --also ekf=ekf.csv");
    picture.tracks.push_back({more.substr(0, equals), read_track_csv(more.substr(equals + 1))});
  }
  picture.tracks.push_back({std::filesystem::path(track_file).stem(), track});
  for (const HarvestedTree& tree : harvested_trees(truth.felled, track))
    picture.harvested.push_back({tree.at, tree.diameter / 2, "#b22222"});
  write_file(how.picture, track_picture(picture));
}

}  // namespace

std::vector<Argument> track_arguments(TrackEvaluation& into) {
  return {
      Argument{"--align", "HOW", &into.align, "track: how it is laid over the truth first"}
          .one_of({"none", "se2", "sim2"})
          .or_else("none"),
      Argument{"--log-format", "FORMAT", &into.log_format, "track: format of a truth that is a log"}
          .one_of({"waymark", "mrclam", "victoria-park"})
          .or_else("recognised"),
      Argument{"--robot", "K", &into.robot, "track: which robot of an MRCLAM dataset is the truth"},
      Argument{"--picture", "FILE.svg", &into.picture, "track: draw truth, track and their errors"}.offering(
          Offer::file),
      Argument{
          "--map", "MAP", &into.map,
          "track: map that the robot used; it is drawn, and a truth in CRS coordinates is put into its frame"}
          .offering(Offer::file),
      Argument{"--also", "NAME=TRACK", &into.also, "track: another track of the picture; may be repeated"},
      Argument{"--longest-gap", "S", &into.longest_gap,
               "track: seconds between two true poses that may be interpolated"}
          .or_else("0.5")};
}

std::string evaluate_track(const std::string& track_file, const std::string& truth_file,
                           const std::string& format, const TrackEvaluation& how) {
  const Track track = read_track_csv(track_file);
  std::optional<OpenedMap> opened;
  if (!how.map.empty()) opened = open_robot_map(how.map, nullptr);
  const Truth truth = truth_of(truth_file, how, opened ? &opened->map.frame : nullptr);
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
  if (!how.picture.empty()) draw(track_file, track, truth, opened ? &*opened : nullptr, how);
  using Json = nlohmann::ordered_json;
  Json all;
  all["poses"] = s.poses;
  all["align"] = how.align;
  all["ate_rmse"] = s.ate_rmse;
  all["ate_median"] = s.ate_median;
  all["ate_largest"] = s.ate_largest;
  all["rpe"] = s.rpe;
  all["heading_rmse_deg"] = s.heading_rmse_deg ? Json(*s.heading_rmse_deg) : nullptr;
  const auto& c = s.consistency;
  all["anees"] = c ? Json(c->anees) : nullptr;
  all["anees_band"] = c ? Json{c->low, c->high} : nullptr;
  all["anees_independent"] = c ? Json(c->independent) : nullptr;
  const auto& v = s.innovations;
  all["anis"] = v ? Json(v->anees) : nullptr;
  all["anis_band"] = v ? Json{v->low, v->high} : nullptr;
  all["matches"] = s.matches;
  all["rejected"] = s.rejected;
  all["wrong_matches"] = s.wrong_matches;
  all["lost"] = s.lost;
  // A track tells it where waymark localize was asked for --timing.
  all["time_per_update_us"] = s.update_seconds ? Json(1e6 * *s.update_seconds) : nullptr;
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
