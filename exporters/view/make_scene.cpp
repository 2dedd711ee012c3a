// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/make_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.hpp"
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/map_drawing.hpp"
#include "exporters/view/view_drive.hpp"
#include "exporters/view/view_layers.hpp"
#include "exporters/view/view_terrain.hpp"

namespace waymark::exporters {
namespace {

constexpr double kMaxOfRadius = 0.25;  // of the body; farther landmarks lie below the horizon of the middle
constexpr double kWideDem = 4;         // times the width of what is on it
constexpr double kMargin = 0.08;

double view_limit(const Crs& crs) {
  return crs.kind() == CrsKind::local ? std::numeric_limits<double>::infinity()
                                      : kMaxOfRadius * crs.body().mean_radius();
}

/// What a view has to contain, in the map frame.
struct Contents {
  Eigen::AlignedBox3d box;
  std::vector<double> heights;  ///< of landmarks
};

Contents contents_of(const std::vector<LandmarkSection>& sections, const LocalFrame& frame,
                     const ViewRequest& request, double limit) {
  Contents all;
  const Eigen::AlignedBox3d within(Eigen::Vector3d::Constant(-limit), Eigen::Vector3d::Constant(limit));
  const auto add = [&](const Eigen::Vector3d& at) {
    if (at.allFinite() && within.contains(at)) all.box.extend(at);
  };
  for (const LandmarkSection& section : sections)
    for (const Landmark& landmark : section.landmarks) {
      const Eigen::Vector3d at = frame.map_frame_from_crs(landmark.position).xyz;
      add(at);
      if (at.allFinite() && within.contains(at)) all.heights.push_back(at.z());
    }
  const double level = all.box.isEmpty() ? 0 : all.box.min().z();
  const auto add_pose = [&](const localization::Pose2& pose) { add({pose.x, pose.y, level}); };
  for (const NamedTrack& track : request.tracks)
    for (const localization::TrackRow& row : track.track.rows) add_pose(row.at.pose);
  if (request.log != nullptr)
    for (const localization::StampedPose& pose : request.log->truth) add_pose(pose.pose);
  return all;
}

Eigen::AlignedBox2d flat(const Eigen::AlignedBox3d& box) {
  return {Eigen::Vector2d(box.min().head<2>()), Eigen::Vector2d(box.max().head<2>())};
}

Eigen::AlignedBox2d widened(Eigen::AlignedBox2d box) {
  const double margin = std::max(kMargin * box.sizes().maxCoeff(), 1.0);
  box.extend(Eigen::Vector2d(box.min().array() - margin));
  box.extend(Eigen::Vector2d(box.max().array() + margin));
  return box;
}

/// Returns the rectangle to show: the DEM's if it is not much wider than its contents. Both in view frame.
Eigen::AlignedBox2d shown_area(const Eigen::AlignedBox2d& contents,
                               const std::optional<Eigen::AlignedBox2d>& dem, double limit) {
  Eigen::AlignedBox2d area = contents.isEmpty() ? *dem : widened(contents);
  const bool fits = dem && !contents.isEmpty() &&
                    dem->sizes().maxCoeff() <= kWideDem * std::max(1.0, contents.sizes().maxCoeff());
  if (fits) area = *dem;
  const Eigen::AlignedBox2d within(Eigen::Vector2d::Constant(-limit), Eigen::Vector2d::Constant(limit));
  return area.intersection(within);
}

void add_notes(ViewScene& scene, const std::vector<LandmarkSection>& sections) {
  for (const LandmarkSection& section : sections)
    for (const ViewLayer& layer : scene.layers)
      if (layer.name == section.type.name && std::cmp_less(layer.landmarks.size(), section.count))
        scene.notes.push_back(fmt::format("{} of {} landmarks of type {} are drawn",
                                          number_text(double(layer.landmarks.size())),
                                          number_text(double(section.count)), readable_name(layer.name)));
  const auto without = std::ranges::count_if(scene.images, [](const ViewImage& i) { return i.jpeg.empty(); });
  if (without > 0) scene.notes.push_back(fmt::format("{} image files are missing", without));
}

}  // namespace

ViewScene make_view_scene(const geodb::MapStore& map, const LocalFrame& frame, const ViewRequest& request) {
  const Crs& crs = map.crs();
  const double limit = view_limit(crs);
  const auto sections =
      landmark_sections(map, static_cast<std::size_t>(std::max<std::int64_t>(0, request.max_landmarks)));
  const Contents contents = contents_of(sections, frame, request, limit);
  const std::vector<std::string> dems = request.dems.empty() ? relief_names(map) : request.dems;
  const ViewFrame map_frame(crs, frame, Eigen::Vector3d::Zero());
  const auto dem = dem_area(dems, map_frame);
  if (contents.box.isEmpty() && !dem &&
      std::ranges::any_of(sections, [](const LandmarkSection& s) { return s.count > 0; }))
    throw Error(
        ErrorCode::input,
        fmt::format(
            "all landmarks lie more than {:.0f} km from the middle of the map, below the horizon there",
            limit / 1000),
        map.path().string(),
        "`waymark export MAP PART.gpkg --aoi AREA` takes a part; `waymark web` and `report` show whole "
        "bodies");
  if (contents.box.isEmpty() && !dem)
    throw Error(ErrorCode::input, "there is nothing to show: no landmarks, no elevation model, no tracks",
                map.path().string(), "give --dem FILE, --log LOG or --track TRACK");
  if (!request.dems.empty() && !dem)
    throw Error(ErrorCode::input, "no elevation model of this map's body and kind of CRS could be read",
                request.dems.front(), "gdalinfo shows what the file is; gdalwarp converts it");

  const Eigen::AlignedBox2d area =
      shown_area(contents.box.isEmpty() ? Eigen::AlignedBox2d() : flat(contents.box), dem, limit);
  if (area.isEmpty())
    throw Error(ErrorCode::input, "the elevation model is too far from the map's middle",
                map.path().string());
  const double level = contents.box.isEmpty() ? 0 : contents.box.min().z();
  const Eigen::Vector3d middle(area.center().x(), area.center().y(), level);
  const ViewFrame view(crs, frame, middle);
  ViewScene scene{
      .title = request.title.empty() ? title_of(map.path().stem().string()) : request.title,
      .place = crs.kind() == CrsKind::local ? "local metres" : crs.body().name + ", " + crs.name(),
      .notes = {},
      .radius = std::max(1.0, area.diagonal().norm() / 2),
      .terrain = {},
      .layers = {},
      .sources = {},
      .tracks = {},
      .scans = {},
      .images = {}};
  const Eigen::AlignedBox2d in_view(area.min() - middle.head<2>(), area.max() - middle.head<2>());
  scene.terrain = make_view_terrain(dems, request.orthophoto, view, in_view, 0);
  ViewLayers layers = make_view_layers(map, sections, view, request.max_landmarks, limit);
  scene.layers = std::move(layers.layers);
  scene.sources = std::move(layers.sources);
  if (request.log != nullptr) {
    if (!request.log->truth.empty()) scene.tracks.push_back(make_view_truth(request.log->truth, view));
    scene.scans = make_view_scans(*request.log);
  }
  for (const NamedTrack& track : request.tracks)
    scene.tracks.push_back(make_view_track(track.name, track.track, view));
  if (request.log != nullptr && scene.tracks.empty())
    scene.notes.push_back("the log has no true poses and no track is given: nothing moves");
  scene.images = make_view_images(request.images, view);
  add_notes(scene, sections);
  return scene;
}

}  // namespace waymark::exporters
