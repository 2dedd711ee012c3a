// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

#include <fmt/format.h>

#include <cmath>

#include "localization/detectors/detected_types.hpp"
#include "localization/filters/locating_filter.hpp"
#include "localization/filters/relocalizing_filter.hpp"
#include "localization/global/range_resection.hpp"
#include "localization/global/skyline_index.hpp"

namespace waymark::workflows {
namespace {

std::vector<localization::SkylineSummit> skyline_summits(const RobotMap& map) {
  std::vector<localization::SkylineSummit> all;
  const auto top = localization::detected_types(map.types()).mountain_top;
  if (!top) return all;
  const LandmarkType* type = &map.types()[*top];
  const auto feature = [&](const Landmark& l, std::string_view name) {
    for (std::size_t i = 0; i < type->features.size() && i < l.features.size(); ++i)
      if (type->features[i].name == name && l.features[i].known()) return l.features[i].value;
    return 0.0;
  };
  for (const Landmark& l : map.store->query({.types = {type->name}})) {
    const Eigen::Vector3d at = map.frame.map_frame_from_crs(l.position).xyz;
    const double height = feature(l, "elevation");
    all.push_back({at.head<2>(), height != 0 ? height : l.position.xyz.z(), feature(l, "prominence"),
                   feature(l, "isolation")});
  }
  return all;
}

/// Returns sightings of mountain tops without range: tops of the horizon.
std::vector<localization::HorizonTop> horizon_tops(const localization::SightingSet& seen,
                                                   std::optional<TypeId> mountain_top) {
  std::vector<localization::HorizonTop> tops;
  for (const localization::SeenLandmark& s : seen.sightings)
    if (s.is_valid() && s.bearing && !s.range && s.elevation && (!s.type || s.type == mountain_top))
      tops.push_back({.bearing = localization::wrap_angle(*s.bearing + seen.robot_from_sensor.yaw),
                      .bearing_sd = s.bearing_sd,
                      .elevation = s.elevation,
                      .elevation_sd = s.elevation_sd});
  return tops;
}

/// Moves the landmark window out of the task.
localization::LandmarkMatcher make_matcher(LocalizeTask& task) {
  localization::FeatureScales scales(task.map.map.types());
  set_alphas(scales, task.map.map.types(), task.settings.identification.alpha);
  localization::IdentificationOptions options = task.settings.identification;
  options.held_types = task.map.map.held_types;
  if (options.use_terrain) options.visible = line_of_sight(task);
  return localization::LandmarkMatcher(std::move(task.map.window), std::move(scales), std::move(options));
}

/// Returns the growth of the search, 1 without identities unless set otherwise: in a map of many landmarks a
/// growing search always finds some fit.
double search_growth(const LocalizeTask& task, double requested) {
  const bool by_default = requested == localization::KalmanOptions{}.search_growth;
  return by_default && !task.settings.identification.use_identities ? 1 : requested;
}

/// Returns the probability that the first of these fixes is wrong.
template <class Fix>
double wrong_probability(const std::vector<Fix>& fixes) {
  std::vector<double> chances;
  for (const Fix& fix : fixes) chances.push_back(fix.log_false_alarms);
  return localization::wrong_probability(chances);
}

/// Adds the answer of a search for constellations to what was found before.
void take(const localization::ConstellationAnswer& answer, localization::PoseSearchResult& found) {
  if (answer.fix) found.accepted = answer.fix->pose();
  for (const localization::ConstellationFix& fix : answer.candidates) found.candidates.push_back(fix.pose());
  found.reason = answer.reason;
  if (!answer.candidates.empty()) found.log_false_alarms = answer.candidates[0].log_false_alarms;
}

/// Keeps the last pose that was accepted, or why there is none. Its time is not known here: NaN.
void record(std::optional<localization::PoseSearchRecord>& record,
            const localization::PoseSearchResult& found) {
  if (found.accepted)
    record = {
        .t = std::nan(""), .at = *found.accepted, .reason = {}, .wrong_probability = found.wrong_probability};
  else if (!record || !record->t)
    record = {
        .t = {}, .at = {}, .reason = std::string(found.reason), .wrong_probability = found.wrong_probability};
}

struct PoseSearch {
  localization::PoseFinder find;
  localization::PoseCheck check;
  localization::NearPoseFinder near;
};

PoseSearch make_pose_search(const LocalizeTask& task, const SearchOptions& search) {
  struct Known {
    localization::ConstellationIndex index;
    std::optional<localization::LandmarkGrid> landmarks;  // made at the first range without bearing
    std::optional<localization::SkylineIndex> skyline;    // made at the first sighting of tops of the horizon
    std::optional<TypeId> top_type;
  };
  const auto open_index = [map = task.map.map, sensor = task.sensor, settings = task.settings.identification,
                           had_pose = task.start.has_value(), search, callbacks = task.callbacks] {
    localization::ConstellationOptions options = search.constellations;
    options.identification = settings;
    options.had_pose = had_pose;
    std::vector<localization::MapLandmark> landmarks = all_landmarks(map, sensor);
    if (landmarks.empty() && map.landmarks > 0)
      callbacks.warning(fmt::format("the map has {} landmarks, too many to search all of it: give a --start",
                                    map.landmarks));
    return Known{.index = localization::ConstellationIndex(std::move(landmarks),
                                                           localization::FeatureScales(map.types()), options),
                 .landmarks = {},
                 .skyline = {},
                 .top_type = localization::detected_types(map.types()).mountain_top};
  };
  localization::SkylineOptions skyline = search.skyline;
  const Body& body = task.map.map.crs().body();
  skyline.body_radius = body.name.empty() ? 0 : body.mean_radius();
  if (body.name == "Earth" && skyline.refraction == 0) skyline.refraction = 0.13;
  const auto known = std::make_shared<std::optional<Known>>();  // the map is read when it is needed first
  const localization::PoseCheck check =
      [known, open_index](
          const localization::SightingSet& seen,
          const localization::PoseEstimate& expected) -> std::optional<localization::PoseEstimate> {
    if (!*known) known->emplace(open_index());
    const auto fix = (*known)->index.check(seen, expected.pose);
    return fix ? std::optional(fix->pose()) : std::nullopt;
  };
  const localization::NearPoseFinder near = [known, open_index](const localization::SightingSet& seen,
                                                                const localization::PoseEstimate& prior) {
    if (!*known) known->emplace(open_index());
    localization::PoseSearchResult found;
    take((*known)->index.find_near(seen, prior), found);
    return found;
  };
  const localization::PoseFinder search_map = [known, open_index, skyline, ground = task.ground,
                                               identities = task.settings.identification.use_identities,
                                               map = task.map.map,
                                               sensor = task.sensor](const localization::SightingSet& seen) {
    if (!*known) known->emplace(open_index());
    localization::PoseSearchResult found;
    if (identities && !seen.earlier_ranges.empty()) {
      if (!(*known)->landmarks) (*known)->landmarks.emplace(all_landmarks(map, sensor));
      found = localization::resect(seen.earlier_ranges, *(*known)->landmarks);
      if (found.accepted || seen.sightings.empty()) return found;
    }
    const auto tops = horizon_tops(seen, (*known)->top_type);
    if (ground && (seen.horizon || tops.size() >= 3)) {
      if (!(*known)->skyline) (*known)->skyline.emplace(skyline_summits(map), ground, skyline);
      localization::SkylineAnswer answer;
      if (seen.horizon) answer = (*known)->skyline->find(*seen.horizon);
      // A part of the horizon, or one with obstacles in front of it, may still have its tops.
      if (!answer.fix && tops.size() >= 3) {
        localization::SkylineAnswer by_tops = (*known)->skyline->find(tops);
        if (by_tops.fix || !seen.horizon) answer = std::move(by_tops);
      }
      if (answer.fix) found.accepted = answer.fix->at;
      for (const localization::SkylineFix& fix : answer.candidates) found.candidates.push_back(fix.at);
      found.reason = answer.reason;
      found.wrong_probability = wrong_probability(answer.candidates);
      if (found.accepted || tops.size() == seen.sightings.size()) return found;
    }
    const localization::ConstellationAnswer answer = (*known)->index.find(seen);
    take(answer, found);
    if (!answer.candidates.empty() && found.candidates.size() == answer.candidates.size())
      found.wrong_probability = wrong_probability(answer.candidates);
    return found;
  };
  const localization::PoseFinder find = [search_map,
                                         searched = task.search](const localization::SightingSet& seen) {
    localization::PoseSearchResult found = search_map(seen);
    record(*searched, found);
    return found;
  };
  return {find, check, near};
}

}  // namespace

localization::PoseFinder make_pose_finder(const LocalizeTask& task, const SearchOptions& search) {
  return make_pose_search(task, search).find;
}

void enable_relocalization(localization::EkfSlam& slam, const LocalizeTask& task,
                           const SearchOptions& search) {
  if (task.map.map.landmarks == 0) return;
  PoseSearch poses = make_pose_search(task, search);
  slam.set_pose_finder(std::move(poses.find), std::move(poses.check));
}

localization::LineOfSight line_of_sight(const LocalizeTask& task) {
  return localization::terrain_line_of_sight(task.ground, task.settings.sight);
}

std::unique_ptr<localization::Localizer> make_particle_localizer(
    LocalizeTask& task, const std::optional<localization::PoseEstimate>& start, const SearchOptions& search) {
  PoseSearch poses = make_pose_search(task, search);
  const localization::PoseFinder finder = std::move(poses.find);
  localization::NearPoseFinder near;
  if (!task.settings.identification.use_identities) near = std::move(poses.near);
  const localization::LandmarkMatcher matcher = make_matcher(task);
  const auto particles = [matcher, &settings = task.settings, visible = line_of_sight(task)](
                             const std::optional<localization::PoseEstimate>& from,
                             localization::PoseFinder finds) {
    auto filter =
        std::make_unique<localization::ParticleFilter>(from, matcher, settings.particles, std::move(finds));
    filter->set_line_of_sight(visible);
    return filter;
  };
  localization::ChanceFraction chance;
  if (!task.settings.identification.use_identities) chance = localization::make_chance_fraction(matcher);
  const auto track =
      [particles, finder, near, chance, scales = localization::FeatureScales(task.map.map.types())](
          const localization::PoseEstimate& found) -> std::unique_ptr<localization::Localizer> {
    return std::make_unique<localization::RelocalizingFilter>(
        found, [particles](const localization::PoseEstimate& from) { return particles(from, {}); }, finder,
        chance, scales, true, near);
  };
  if (start) return track(*start);
  return std::make_unique<localization::LocatingFilter>(particles({}, finder), track);
}

std::unique_ptr<localization::Localizer> make_kalman_localizer(LocalizeTask& task,
                                                               const SearchOptions& search, bool unscented) {
  const localization::IdentificationOptions& identification = task.settings.identification;
  const localization::LandmarkMatcher matcher = make_matcher(task);
  localization::ChanceFraction chance;
  if (!identification.use_identities) chance = localization::make_chance_fraction(matcher);
  const auto make = [unscented, matcher, &settings = task.settings, visible = line_of_sight(task),
                     growth = search_growth(task, task.settings.kalman.search_growth)](
                        const localization::PoseEstimate& start) -> std::unique_ptr<localization::Localizer> {
    const localization::IdentificationOptions& id = settings.identification;
    if (id.use_identities || id.chosen_association() != "joint") {
      localization::KalmanOptions options = settings.kalman;
      options.search_growth = growth;
      options.error_memory_distance = settings.hypotheses.error_correlation_distance;
      if (unscented) return std::make_unique<localization::UnscentedKalman>(start, matcher, options);
      return std::make_unique<localization::ExtendedKalman>(start, matcher, options);
    }
    localization::MultiHypothesisOptions options = settings.hypotheses;
    options.unscented = unscented;
    options.search = settings.kalman;
    options.search.search_growth = growth;
    auto filter = std::make_unique<localization::MultiHypothesisFilter>(start, matcher, options);
    filter->expect_landmarks(settings.particles.weight, visible);
    return filter;
  };
  const localization::PoseEstimate start =
      task.start.value_or(localization::pose_anywhere(task.map.map.bounds));
  PoseSearch poses = make_pose_search(task, search);
  return std::make_unique<localization::RelocalizingFilter>(
      start, make, std::move(poses.find), std::move(chance),
      localization::FeatureScales(task.map.map.types()), task.start.has_value(),
      identification.use_identities ? localization::NearPoseFinder{} : poses.near);
}

}  // namespace waymark::workflows
