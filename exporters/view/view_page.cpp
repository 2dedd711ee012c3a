// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/view_page.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/escape_markup.hpp"
#include "exporters/report/base64.hpp"
#include "exporters/report/script_policy.hpp"
#include "exporters/view/view_assets.hpp"
#include "exporters/view/view_form.hpp"

namespace waymark::exporters {
namespace {

using ViewJson = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "the page stores arrays in little-endian order");

template <class T>
std::string packed(const std::vector<T>& values) {
  return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

/// Heights as 16-bit steps from the lowest to the highest; 65535: unknown.
ViewJson terrain_json(const ViewTerrain& terrain) {
  const auto cells = terrain.heights.cells();
  if (cells.empty()) return nullptr;
  float lowest = 0, highest = 0;
  bool any = false;
  for (const float h : cells) {
    if (!std::isfinite(h)) continue;
    lowest = any ? std::min(lowest, h) : h;
    highest = any ? std::max(highest, h) : h;
    any = true;
  }
  constexpr float levels = 65534;
  const float range = std::max(highest - lowest, 1e-3F);
  std::vector<std::uint16_t> steps;
  for (const float h : cells)
    steps.push_back(std::isfinite(h) ? static_cast<std::uint16_t>(std::lround((h - lowest) / range * levels))
                                     : std::uint16_t{65535});
  return {{"columns", terrain.heights.columns()},
          {"rows", terrain.heights.rows()},
          {"west", terrain.west},
          {"south", terrain.south},
          {"step", terrain.step},
          {"lowest", lowest},
          {"height_step", range / levels},
          {"heights", packed(steps)},
          {"picture", terrain.picture.empty() ? "" : "data:image/jpeg;base64," + base64(terrain.picture)},
          {"caption", terrain.caption}};
}

ViewJson layer_json(const ViewLayer& layer) {
  ViewJson features = ViewJson::array();
  for (const ViewFeature& f : layer.features)
    features.push_back({{"title", f.title},
                        {"summary", f.summary},
                        {"unit", f.format.unit},
                        {"factor", f.format.factor},
                        {"decimals", f.format.decimals}});
  std::vector<float> numbers, values, forms;
  std::vector<std::int32_t> counts;
  std::vector<float> evidence;
  ViewJson uids = ViewJson::array(), positions = ViewJson::array(), labels = ViewJson::array();
  const bool oriented = is_oriented(layer.shape);
  for (const ViewLandmark& l : layer.landmarks) {
    for (const float n : {l.at.x(), l.at.y(), l.at.z(), l.radius, l.height, l.confidence, l.quality, l.sd[0],
                          l.sd[1], l.sd[2]})
      numbers.push_back(n);
    for (const auto& feature : l.features) values.insert(values.end(), feature.begin(), feature.end());
    for (const std::int32_t n :
         {l.seen, l.visible, l.observations, static_cast<std::int32_t>(l.evidence.size())})
      counts.push_back(n);
    for (const ViewEvidence& e : l.evidence) {
      evidence.push_back(static_cast<float>(e.source));
      evidence.push_back(e.confidence);
    }
    if (oriented)
      for (const float n : {l.form.turn, l.form.length, l.form.width, l.form.opening, l.form.side})
        forms.push_back(n);
    uids.push_back(l.uid);
    positions.push_back(l.position);
    labels.push_back(l.label);
  }
  return {{"name", layer.name},
          {"title", layer.title},
          {"colour", layer.colour},
          {"shape", layer.shape},
          {"total", layer.total},
          {"features", features},
          {"uids", uids},
          {"positions", positions},
          {"labels", labels},
          {"numbers", packed(numbers)},
          {"forms", packed(forms)},
          {"values", packed(values)},
          {"counts", packed(counts)},
          {"evidence", packed(evidence)}};
}

ViewJson track_json(const ViewTrack& track, double start) {
  std::vector<float> numbers;
  for (const ViewPose& p : track.poses)
    for (const float n :
         {static_cast<float>(p.t - start), p.x, p.y, p.yaw, p.var_x, p.var_y, p.cov_xy, p.lost ? 1.F : 0.F})
      numbers.push_back(n);
  return {{"name", track.name}, {"truth", track.is_truth}, {"numbers", packed(numbers)}};
}

ViewJson scans_json(const std::vector<ViewScan>& scans, double start) {
  std::vector<float> heads, rays;
  for (const ViewScan& scan : scans) {
    for (const float n : {static_cast<float>(scan.t - start), scan.is_laser ? 1.F : 0.F, scan.mount.x(),
                          scan.mount.y(), static_cast<float>(scan.rays.size())})
      heads.push_back(n);
    for (const ViewRay& ray : scan.rays) {
      rays.push_back(ray.bearing);
      rays.push_back(ray.range);
    }
  }
  return {{"heads", packed(heads)}, {"rays", packed(rays)}};
}

ViewJson image_json(const ViewImage& image) {
  std::vector<double> rotation, border;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation.push_back(image.frame_from_camera(r, c));
  for (const Eigen::Vector3d& ray : image.border)
    for (int i = 0; i < 3; ++i) border.push_back(ray(i));
  return {{"name", image.name},
          {"columns", image.columns},
          {"rows", image.rows},
          {"centre", {image.centre.x(), image.centre.y(), image.centre.z()}},
          {"rotation", rotation},
          {"lens", image.lens},
          {"distortion", image.distortion},
          {"fisheye", image.is_fisheye},
          {"max_radius", image.max_radius},
          {"border", border},
          {"picture", image.jpeg.empty() ? "" : "data:image/jpeg;base64," + base64(image.jpeg)}};
}

double start_of(const ViewScene& scene) {
  double start = std::numeric_limits<double>::infinity();
  for (const ViewTrack& track : scene.tracks)
    if (!track.poses.empty()) start = std::min(start, track.poses.front().t);
  if (!scene.scans.empty()) start = std::min(start, scene.scans.front().t);
  return std::isfinite(start) ? start : 0;
}

ViewJson scene_json(const ViewScene& scene) {
  const double start = start_of(scene);
  ViewJson json{{"title", scene.title},   {"place", scene.place},     {"notes", scene.notes},
                {"radius", scene.radius}, {"sources", scene.sources}, {"start", start}};
  json["terrain"] = terrain_json(scene.terrain);
  for (const char* list : {"layers", "tracks", "images"}) json[list] = ViewJson::array();
  for (const ViewLayer& layer : scene.layers) json["layers"].push_back(layer_json(layer));
  for (const ViewTrack& track : scene.tracks) json["tracks"].push_back(track_json(track, start));
  for (const ViewImage& image : scene.images) json["images"].push_back(image_json(image));
  json["scans"] = scans_json(scene.scans, start);
  return json;
}

}  // namespace

std::string view_page(const ViewScene& scene) {
  const std::string data =
      script_data(scene_json(scene).dump(-1, ' ', false, ViewJson::error_handler_t::replace));
  const std::string title = escape_markup(scene.title);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n{}\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<meta name='generator' "
      "content='Waymark'>\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n"
      "<noscript><p>{} is drawn by a script, which this browser does not run. `waymark report` makes a page "
      "without.</p></noscript>\n<script type='application/json' id='scene'>{}</script>\n"
      "<script>{}</script>\n</body>\n</html>\n",
      script_policy(kViewScript), title, kViewStyle, title, data, kViewScript);
}

}  // namespace waymark::exporters
