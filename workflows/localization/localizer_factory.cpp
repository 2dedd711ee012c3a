// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

#include <fmt/format.h>

#include "localization/filters/relocalizing_filter.hpp"
#include "localization/global/skyline_index.hpp"

namespace waymark {
namespace {

std::vector<SkylineSummit> skyline_summits(const RobotMap& map) {
  std::vector<SkylineSummit> all;
  const LandmarkType* type = map.types().find("mountain_top");
  if (!type) return all;
  const auto feature = [&](const Landmark& l, std::string_view name) {
    for (std::size_t i = 0; i < type->features.size() && i < l.features.size(); ++i)
      if (type->features[i].name == name && l.features[i].known()) return l.features[i].value;
    return 0.0;
  };
  for (const Landmark& l : map.store->query({.types = {"mountain_top"}})) {
    const Eigen::Vector3d at = map.frame.map_frame_from_crs(l.position).xyz;
    const double height = feature(l, "elevation");
    all.push_back({at.head<2>(), height != 0 ? height : l.position.xyz.z(), feature(l, "prominence"),
                   feature(l, "isolation")});
  }
  return all;
}

/// Returns sightings of mountain tops without range: tops of the horizon.
std::vector<HorizonTop> horizon_tops(const SightingSet& seen, std::optional<TypeId> mountain_top) {
  std::vector<HorizonTop> tops;
  for (const SeenLandmark& s : seen.sightings)
    if (s.is_valid() && !s.range && s.elevation && (!s.type || s.type == mountain_top))
      tops.push_back({.bearing = wrap_angle(s.bearing + seen.robot_from_sensor.yaw),
                      .bearing_sd = s.bearing_sd,
                      .elevation = s.elevation,
                      .elevation_sd = s.elevation_sd});
  return tops;
}

/// Returns the growth of the search, 1 without identities unless set otherwise: in a map of many landmarks a
/// growing search always finds some fit.
double search_growth(const LocalizeTask& task, double requested) {
  const bool by_default = requested == KalmanOptions{}.search_growth;
  return by_default && !task.settings.identification.use_identities ? 1 : requested;
}

}  // namespace

PoseFinder make_pose_finder(const LocalizeTask& task, const SearchOptions& search) {
  struct Known {
    ConstellationIndex index;
    std::optional<SkylineIndex> skyline;  // made at the first sighting of tops of the horizon
    std::optional<TypeId> top_type;
  };
  const auto open_index = [map = task.map.map, sensor = task.sensor, settings = task.settings.identification,
                           search, callbacks = task.callbacks] {
    ConstellationOptions options = search.constellations;
    options.identification = settings;
    std::vector<MapLandmark> landmarks = all_landmarks(map, sensor);
    if (landmarks.empty() && map.landmarks > 0)
      callbacks.warning(fmt::format("the map has {} landmarks, too many to search all of it: give a --start",
                                    map.landmarks));
    return Known{.index = ConstellationIndex(std::move(landmarks), FeatureScales(map.types()), options),
                 .skyline = {},
                 .top_type = map.types().find("mountain_top")
                                 ? std::optional<TypeId>(map.types().id("mountain_top"))
                                 : std::nullopt};
  };
  SkylineOptions skyline = search.skyline;
  const Body& body = task.map.map.crs().body();
  skyline.body_radius = body.name.empty() ? 0 : body.mean_radius();
  if (body.name == "Earth" && skyline.refraction == 0) skyline.refraction = 0.13;
  const auto known = std::make_shared<std::optional<Known>>();  // the map is read when it is needed first
  return [known, open_index, skyline, ground = task.ground, map = task.map.map](const SightingSet& seen) {
    if (!*known) known->emplace(open_index());
    PoseSearchResult found;
    const auto tops = horizon_tops(seen, (*known)->top_type);
    if (tops.size() >= 3 && ground) {
      if (!(*known)->skyline) (*known)->skyline.emplace(skyline_summits(map), ground, skyline);
      const SkylineAnswer answer = (*known)->skyline->find(tops);
      if (answer.fix) found.accepted = answer.fix->at;
      for (const SkylineFix& fix : answer.candidates) found.candidates.push_back(fix.at);
      found.reason = answer.reason;
      if (found.accepted) return found;
    }
    const ConstellationAnswer answer = (*known)->index.find(seen);
    if (answer.fix) found.accepted = answer.fix->pose();
    for (const ConstellationFix& fix : answer.candidates) found.candidates.push_back(fix.pose());
    found.reason = answer.reason;
    return found;
  };
}

LineOfSight line_of_sight(const LocalizeTask& task) {
  return terrain_line_of_sight(task.ground, task.settings.sight);
}

std::unique_ptr<Localizer> make_particle_localizer(LocalizeTask& task,
                                                   const std::optional<PoseEstimate>& start,
                                                   const SearchOptions& search) {
  PoseFinder finder = make_pose_finder(task, search);
  const auto particles = [window = std::move(task.map.window), scales = FeatureScales(task.map.map.types()),
                          &settings = task.settings, visible = line_of_sight(task)](
                             const std::optional<PoseEstimate>& from, PoseFinder finds) {
    auto filter = std::make_unique<ParticleFilter>(from, window, scales, settings.identification,
                                                   settings.particles, std::move(finds));
    filter->set_line_of_sight(visible);
    return filter;
  };
  if (!start) return particles({}, std::move(finder));
  return std::make_unique<RelocalizingFilter>(
      *start, [particles](const PoseEstimate& from) { return particles(from, {}); }, std::move(finder),
      ChanceFraction(), FeatureScales(task.map.map.types()));
}

std::unique_ptr<Localizer> make_kalman_localizer(LocalizeTask& task, const SearchOptions& search,
                                                 bool unscented) {
  const IdentificationOptions& identification = task.settings.identification;
  ChanceFraction chance;
  if (!identification.use_identities)
    chance = make_chance_fraction(task.map.window, FeatureScales(task.map.map.types()), identification);
  const auto make = [unscented, window = std::move(task.map.window),
                     scales = FeatureScales(task.map.map.types()), &settings = task.settings,
                     visible = line_of_sight(task),
                     growth = search_growth(task, task.settings.kalman.search_growth)](
                        const PoseEstimate& start) -> std::unique_ptr<Localizer> {
    const IdentificationOptions& id = settings.identification;
    if (id.use_identities || id.chosen_association() != "joint") {
      KalmanOptions options = settings.kalman;
      options.search_growth = growth;
      if (unscented) return std::make_unique<UnscentedKalman>(start, window, scales, id, options);
      return std::make_unique<ExtendedKalman>(start, window, scales, id, options);
    }
    MultiHypothesisOptions options = settings.hypotheses;
    options.unscented = unscented;
    options.search = settings.kalman;
    options.search.search_growth = growth;
    auto filter = std::make_unique<MultiHypothesisFilter>(start, window, scales, id, options);
    filter->expect_landmarks(settings.particles.weight, visible);
    return filter;
  };
  return std::make_unique<RelocalizingFilter>(*task.start, make, make_pose_finder(task, search),
                                              std::move(chance), FeatureScales(task.map.map.types()));
}

}  // namespace waymark
