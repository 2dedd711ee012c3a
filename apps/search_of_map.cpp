// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/localize_method.hpp"
#include "apps/log.hpp"
#include "localization/filters/restarting.hpp"
#include "localization/global/skyline_index.hpp"

namespace waymark {
namespace {

std::vector<SkylineSummit> summits_of(const RobotMap& map) {
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

/// Sightings of mountain tops without range are tops of the horizon.
std::vector<HorizonTop> tops_of(const SightingSet& seen, std::optional<TypeId> mountain_top) {
  std::vector<HorizonTop> tops;
  for (const SeenLandmark& s : seen.sightings)
    if (s.sound() && !s.range && s.elevation && (!s.type || s.type == mountain_top))
      tops.push_back({.bearing = wrapped(s.bearing + seen.robot_from_sensor.yaw),
                      .bearing_sd = s.bearing_sd,
                      .elevation = s.elevation,
                      .elevation_sd = s.elevation_sd});
  return tops;
}

}  // namespace

PoseFinder finder_for(const LocalizeTask& task, const SearchOptions& search) {
  struct Known {
    ConstellationIndex index;
    std::optional<SkylineIndex> skyline;  // made when tops of the horizon are seen first
    std::optional<TypeId> top_type;
  };
  const auto begin = [map = task.map.map, sensor = task.sensor, settings = task.settings.identification,
                      search] {
    ConstellationOptions options = search.constellations;
    options.use_identities = settings.use_identities;
    options.feature_tolerance = settings.feature_tolerance;
    options.feature_limit = settings.feature_limit;
    std::vector<MapLandmark> landmarks = all_landmarks(map, sensor);
    if (landmarks.empty() && map.landmarks > 0)
      log_warning(fmt::format("the map has {} landmarks, too many to search all of it: give a --start",
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
  const auto known =
      std::make_shared<std::optional<Known>>();  // the map is searched first when that is needed
  return [known, begin, skyline, ground = task.ground, map = task.map.map](const SightingSet& seen) {
    if (!*known) known->emplace(begin());
    FoundPoses found;
    const auto tops = tops_of(seen, (*known)->top_type);
    if (tops.size() >= 3 && ground) {
      if (!(*known)->skyline) (*known)->skyline.emplace(summits_of(map), ground, skyline);
      const SkylineAnswer answer = (*known)->skyline->find(tops);
      if (answer.fix) found.sure = answer.fix->at;
      for (const SkylineFix& fix : answer.candidates) found.possible.push_back(fix.at);
      found.reason = answer.reason;
      if (found.sure) return found;
    }
    const ConstellationAnswer answer = (*known)->index.find(seen);
    if (answer.fix) found.sure = answer.fix->pose();
    for (const ConstellationFix& fix : answer.candidates) found.possible.push_back(fix.pose());
    found.reason = answer.reason;
    return found;
  };
}

double search_growth(const LocalizeTask& task, double wished) {
  const bool by_default = wished == KalmanOptions{}.search_growth;
  return by_default && !task.settings.identification.use_identities ? 1 : wished;
}

std::unique_ptr<Localizer> searching_particles(LocalizeTask& task, const std::optional<PoseEstimate>& start,
                                               const SearchOptions& search) {
  PoseFinder finder = finder_for(task, search);
  const auto particles = [window = std::move(task.map.window), scales = FeatureScales(task.map.map.types()),
                          &settings = task.settings,
                          visible = sight_of(task)](const std::optional<PoseEstimate>& from, PoseFinder by) {
    auto filter = std::make_unique<ParticleFilter>(from, window, scales, settings.identification,
                                                   settings.particles, std::move(by));
    filter->look_over(visible);
    return filter;
  };
  if (!start) return particles({}, std::move(finder));
  return std::make_unique<Restarting>(
      *start, [particles](const PoseEstimate& from) { return particles(from, {}); }, std::move(finder));
}

std::unique_ptr<Localizer> searching_kalman(LocalizeTask& task, const SearchOptions& search, bool unscented) {
  const IdentificationOptions& how = task.settings.identification;
  ChanceShare chance;
  if (!how.use_identities) chance = chance_share(task.map.window, FeatureScales(task.map.map.types()), how);
  const auto begin = [unscented, window = std::move(task.map.window),
                      scales = FeatureScales(task.map.map.types()), &settings = task.settings,
                      visible = sight_of(task),
                      growth = search_growth(task, task.settings.kalman.search_growth)](
                         const PoseEstimate& start) -> std::unique_ptr<Localizer> {
    const IdentificationOptions& id = settings.identification;
    if (id.use_identities || id.association != "joint") {
      KalmanOptions options = settings.kalman;
      options.search_growth = growth;
      if (unscented) return std::make_unique<UnscentedKalman>(start, window, scales, id, options);
      return std::make_unique<ExtendedKalman>(start, window, scales, id, options);
    }
    HypothesesOptions options = settings.hypotheses;
    options.unscented = unscented;
    options.search_growth = growth;
    auto filter = std::make_unique<HypothesesFilter>(start, window, scales, id, options);
    filter->expect_landmarks(settings.particles.weight, visible);
    return filter;
  };
  return std::make_unique<Restarting>(*task.start, begin, finder_for(task, search), std::move(chance));
}

}  // namespace waymark
