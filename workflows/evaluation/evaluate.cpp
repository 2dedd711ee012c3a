// SPDX-License-Identifier: Apache-2.0
#include "workflows/evaluation/evaluate.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "exporters/report/track_picture.hpp"
#include "exporters/vector/track_file.hpp"
#include "importers/logs/import_log.hpp"
#include "localization/harvested_trees.hpp"
#include "localization/robot_log.hpp"
#include "workflows/evaluation/scored_table.hpp"
#include "workflows/localization/robot_map.hpp"
#include "workflows/registries.hpp"
#include "workflows/sensor_file.hpp"

namespace waymark::workflows {
namespace {

struct Truth {
  std::vector<localization::StampedPose> poses;
  std::vector<localization::FelledReading> felled;
  bool headings = true;
  std::string crs = {};  ///< of the poses; empty: the frame of the map
};

/// Reads a track in the frame of the truth. Throws Error{usage} if one is in a CRS and the other is not.
localization::Track read_track_beside(const std::string& file, const Truth& truth, const LocalFrame* frame) {
  if (frame) return exporters::read_track(file, frame);
  exporters::TrackFile read = exporters::read_track_file(file);
  const auto name = [](const std::string& crs) {
    return crs.empty() ? std::string("the frame of a map") : Crs::from_text(crs).id();
  };
  const bool same = read.crs.empty()
                        ? truth.crs.empty()
                        : !truth.crs.empty() && Crs::from_text(read.crs).same_as(Crs::from_text(truth.crs));
  if (!same)
    throw Error(ErrorCode::usage,
                fmt::format("the track is in {}, the truth in {}", name(read.crs), name(truth.crs)), file,
                "give --map MAP: both are compared in its frame; a column `crs` of a track names its CRS");
  if (!read.crs.empty() && Crs::from_text(read.crs).metres_per_unit() != 1)
    throw Error(ErrorCode::usage, fmt::format("the track is in {}, which is not in metres", name(read.crs)),
                file, "give --map MAP");
  return std::move(read.track);
}

/// Returns the CRS of the true poses; empty for a local one, whose coordinates are those of the map frame.
std::string crs_of(const localization::RobotLog& log) {
  if (!log.in_crs || log.crs.empty()) return {};
  return Crs::from_text(log.crs).kind() == CrsKind::local ? "" : log.crs;
}

/// Throws if true poses are coordinates that are no metres.
void check_metres(const localization::RobotLog& log, const std::string& file) {
  if (!log.in_crs || log.crs.empty() || log.truth.empty()) return;
  const Crs crs = Crs::from_text(log.crs);
  if (crs.kind() == CrsKind::local || (crs.kind() == CrsKind::projected && crs.metres_per_unit() == 1))
    return;
  throw Error(ErrorCode::usage, fmt::format("the true poses are in {}, which is not in metres", crs.id()),
              file, "give --map MAP, and a track that was written without --crs");
}

Truth read_truth(const TrackEvaluation& request, const LocalFrame* frame) {
  const std::string& file = request.truth;
  if (request.log_format.format.empty() && (file.ends_with(".csv") || file.ends_with(".tum"))) {
    Truth truth;
    const exporters::TrackFile read =
        frame ? exporters::TrackFile{exporters::read_track(file, frame)} : exporters::read_track_file(file);
    truth.crs = read.crs;
    for (const localization::TrackRow& row : read.track.rows) truth.poses.push_back({row.t, row.at.pose});
    return truth;
  }
  localization::RobotLog log = importers::import_log(file, all_types(), request.log_format);
  if (frame)
    localization::convert_to_map_frame(log, *frame);
  else
    check_metres(log, file);
  Truth truth{log.truth, log.felled, false, frame ? std::string() : crs_of(log)};
  for (const localization::StampedPose& p : log.truth) truth.headings = truth.headings || p.pose.yaw != 0;
  return truth;
}

// Returns a colour halfway to white, so that tracks stand out.
std::string paler(const std::string& colour) {
  std::string pale = "#";
  for (const std::size_t i : {1, 3, 5})
    pale += fmt::format("{:02x}", (std::stoi(colour.substr(i, 2), nullptr, 16) + 255) / 2);
  return pale;
}

// Returns the size of a dot: a radius, or a diameter where that is the measure of what a robot sees.
double dot_size(const localization::MapLandmark& landmark, const LandmarkType& type) {
  for (std::size_t i = 0; i < std::min(type.features.size(), localization::kMaxFeatures); ++i)
    if ((type.features[i].name == "radius" || type.features[i].name == "diameter") &&
        landmark.features.known(i))
      return landmark.features.value[i];
  return 0.5;
}

std::vector<exporters::PictureDot> map_dots(OpenedMap& opened) {
  std::vector<exporters::PictureDot> dots;
  for (const localization::MapLandmark& l : opened.window.landmarks_near({0, 0}, 0).landmarks()) {
    const LandmarkType& type = opened.map.types()[l.type];
    if (type.evidence == EvidenceModel::bowl) continue;  // wide discs would hide the rest
    dots.push_back({l.at, dot_size(l, type), paler(type.colour)});
  }
  return dots;
}

void draw(const TrackEvaluation& request, const localization::Track& track, const Truth& truth,
          OpenedMap* opened) {
  const LocalFrame* frame = opened ? &opened->map.frame : nullptr;
  if (!request.picture.ends_with(".svg"))
    throw Error(ErrorCode::usage, "a picture of tracks is written as .svg", request.picture);
  exporters::TrackPicture picture{.title = request.align == "none"
                                               ? "Estimated tracks and the truth"
                                               : "Estimated tracks and the truth, not aligned",
                                  .map = {},
                                  .truth = truth.poses,
                                  .tracks = {},
                                  .mapped = {}};
  if (opened) picture.map = map_dots(*opened);
  for (const std::string& more : request.also) {
    const std::size_t equals = more.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorCode::usage, "--also takes NAME=TRACK.csv, is '" + more + "'", "",
                  "e.g. --also ekf=ekf.csv");
    picture.tracks.push_back(
        {more.substr(0, equals), read_track_beside(more.substr(equals + 1), truth, frame)});
  }
  picture.tracks.push_back({std::filesystem::path(request.track).stem(), track});
  for (const localization::HarvestedTree& tree : localization::harvested_trees(truth.felled, track))
    picture.mapped.push_back({tree.at, tree.diameter / 2, "#b22222"});
  write_file(request.picture, exporters::track_picture(picture));
}

ScoredTables read_truth(const LandmarkEvaluation& request) {
  ScoredTables truth = read_scored_things(request.truth, request.type, request.min_pixels);
  if (request.ignore.empty()) return truth;
  for (auto& [type, things] : read_scored_things(request.ignore, request.type, 0))
    for (testbed::EvaluatedObject& thing : things) {
      thing.ignored = true;
      truth[type].push_back(thing);
    }
  return truth;
}

/// Throws why no row of the track has a true pose: other times, or a truth too coarse to interpolate.
[[noreturn]] void refuse_times(const TrackEvaluation& request, const localization::Track& track,
                               const std::vector<localization::StampedPose>& truth) {
  if (track.rows.empty())
    throw Error(ErrorCode::input, "the track has no rows", request.track,
                "waymark localize writes one per event");
  const double from = track.rows.front().t, to = track.rows.back().t;
  double gap = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) gap = std::max(gap, truth[i].t - truth[i - 1].t);
  if (from <= truth.back().t && truth.front().t <= to && gap > request.max_gap)
    throw Error(
        ErrorCode::input,
        fmt::format(
            "the true poses are up to {:.3g} s apart; only those at most {:.3g} s apart are interpolated",
            gap, request.max_gap),
        request.truth, fmt::format("pass --max-gap {:.3g}", 1.01 * gap));
  throw Error(ErrorCode::input,
              fmt::format("track and truth have no time in common: {:.3f} to {:.3f} s and {:.3f} to {:.3f} s",
                          from, to, truth.front().t, truth.back().t),
              request.track, "are they of the same drive, and both in seconds?");
}

/// Warns about types without a match, and says why that may be.
void warn_unmatched(const std::string& type, const std::vector<testbed::EvaluatedObject>& found,
                    const std::vector<testbed::EvaluatedObject>& truth, const testbed::Score& result,
                    const Callbacks& callbacks) {
  if (result.all.matched > 0 || truth.empty()) return;
  if (found.empty()) return callbacks.warning("the result has no " + type + ": nothing can match");
  const auto extent = [](const std::vector<testbed::EvaluatedObject>& things) {
    Eigen::AlignedBox2d box;
    for (const testbed::EvaluatedObject& thing : things) box.extend(thing.at);
    return box;
  };
  const Eigen::AlignedBox2d a = extent(found), b = extent(truth);
  const auto text = [](const Eigen::AlignedBox2d& box) {
    return fmt::format("x {:.10g} to {:.10g}, y {:.10g} to {:.10g}", box.min().x(), box.max().x(),
                       box.min().y(), box.max().y());
  };
  callbacks.warning(fmt::format("no {} of the result matches a true one: the result has {}, the truth {}; {}",
                                type, text(a), text(b),
                                a.intersects(b) ? "--tolerance and --min-tolerance allow larger distances"
                                                : "are both in one coordinate system?"));
}

}  // namespace

std::map<std::string, testbed::Score> evaluate(const LandmarkEvaluation& request,
                                               const Callbacks& callbacks) {
  if (!(request.max_distance >= 0) || !(request.always_allowed_distance >= 0) || !(request.min_diameter >= 0))
    throw Error(ErrorCode::usage, "distances and sizes are not negative", "evaluate landmarks");
  if (!std::ranges::is_sorted(request.size_edges))
    throw Error(ErrorCode::usage, "the diameters of --size-edges do not ascend", "evaluate landmarks",
                "e.g. --size-edges 1 2 5");
  const std::shared_ptr<const SensorProfile> sensor =
      request.sensor.empty() ? nullptr : find_sensor(request.sensor, request.result);
  const ScoredTables found = read_scored_things(request.result, request.type, 0, sensor.get());
  const ScoredTables truth = read_truth(request);
  testbed::MatchRules rules{.by = request.match_by == "overlap" ? testbed::MatchRules::By::overlap
                                                                : testbed::MatchRules::By::distance,
                            .distance_fraction = request.max_distance,
                            .min_distance = request.always_allowed_distance,
                            .min_diameter = request.min_diameter};
  std::map<std::string, testbed::Score> scores;
  for (const auto& [type, things] : pair_by_type(found, truth, request.type)) {
    rules.scales.clear();
    if (const LandmarkType* known = all_types().find(type))
      for (const FeatureSpec& feature : known->features) rules.scales[feature.name] = feature.scale;
    scores[type] = score(things.first, things.second, rules, request.size_edges);
    warn_unmatched(type, things.first, things.second, scores[type], callbacks);
  }
  if (scores.empty())
    callbacks.warning(fmt::format(
        "{} has no landmarks{}: nothing can be compared; it has one row per true landmark, with x and y",
        request.truth, request.type.empty() ? "" : " of type " + request.type));
  return scores;
}

localization::TrackScore evaluate(const TrackEvaluation& request) {
  check_number("--max-gap", request.max_gap, "s", {.help = "", .min = 0, .max = 1e9});
  std::optional<OpenedMap> opened;
  if (!request.map.empty()) opened = open_robot_map(request.map, nullptr);
  const Truth truth = read_truth(request, opened ? &opened->map.frame : nullptr);
  if (truth.poses.empty())
    throw Error(ErrorCode::input, "the truth has no poses", request.truth, "is it a log without true poses?");
  const localization::Track track =
      read_track_beside(request.track, truth, opened ? &opened->map.frame : nullptr);
  const localization::TrackAlignment alignment = request.align == "se2" ? localization::TrackAlignment::se2
                                                 : request.align == "sim2"
                                                     ? localization::TrackAlignment::sim2
                                                     : localization::TrackAlignment::none;
  localization::TrackScore s = score(track, truth.poses, alignment, truth.headings, 1, request.max_gap);
  if (s.poses == 0) refuse_times(request, track, truth.poses);
  if (!request.picture.empty()) draw(request, track, truth, opened ? &*opened : nullptr);
  return s;
}

std::vector<localization::TrackErrorAt> track_errors(const TrackEvaluation& request) {
  std::optional<OpenedMap> opened;
  if (!request.map.empty()) opened = open_robot_map(request.map, nullptr);
  const LocalFrame* frame = opened ? &opened->map.frame : nullptr;
  const Truth truth = read_truth(request, frame);
  return localization::track_errors(read_track_beside(request.track, truth, frame), truth.poses,
                                    request.max_gap);
}

std::vector<exporters::QualityCheck> check_quality(const std::string& map, const std::string& truth) {
  const auto pairs = pair_by_type(read_scored_things(map, "", 0),
                                  read_scored_things(truth, "", LandmarkEvaluation{}.min_pixels), "");
  std::vector<exporters::QualityCheck> checks;
  for (const auto& [type, things] : pairs) {
    const testbed::Score result = score(things.first, things.second, {});
    for (const auto& [claim, bins, error] :
         {std::tuple{"confidence", result.by_confidence, result.confidence_error},
          {"quality", result.by_quality, result.quality_error}}) {
      exporters::QualityCheck check{.type = type, .claim = claim, .bins = {}, .expected_error = error};
      for (const testbed::CalibrationBin& bin : bins) check.bins.push_back({bin.mean, bin.found, bin.right});
      checks.push_back(std::move(check));
    }
  }
  return checks;
}

}  // namespace waymark::workflows
