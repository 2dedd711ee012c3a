// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/robot_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/covariance.hpp"
#include "core/error.hpp"
#include "core/locked_folder.hpp"
#include "geodb/write_map.hpp"
#include "importers/rasters/dem.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kMaxReadAtOnce = 200000;
constexpr double kMargin = 25;  // m: a window of some hundred landmarks is read in well under 1 ms

/// Returns the middle of geographic positions: the direction of the sum of their unit vectors, so that
/// neither the antimeridian nor a pole matters. The first position if they cancel out.
Eigen::Vector2d middle_direction(const std::vector<Landmark>& landmarks) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Landmark& l : landmarks) {
    const Eigen::Vector2d angle = l.position.xyz.head<2>() * kRadiansPerDegree;
    sum += Eigen::Vector3d(std::cos(angle.y()) * std::cos(angle.x()),
                           std::cos(angle.y()) * std::sin(angle.x()), std::sin(angle.y()));
  }
  if (!(sum.norm() > 1e-3 * static_cast<double>(landmarks.size())))
    return landmarks[0].position.xyz.head<2>();
  return Eigen::Vector2d(std::atan2(sum.y(), sum.x()), std::atan2(sum.z(), sum.head<2>().norm())) /
         kRadiansPerDegree;
}

Point<MapCrs> frame_origin(const geodb::MapStore& store) {
  if (store.crs().kind() == CrsKind::local) return {};
  const std::vector<Landmark> some = store.query({.limit = 1000});
  Point<MapCrs> origin;
  double heights = 0, known = 0;
  for (const Landmark& l : some) {
    origin.xyz += l.position.xyz / static_cast<double>(some.size());
    if (std::isfinite(l.position.xyz.z())) heights += l.position.xyz.z(), ++known;
  }
  if (!some.empty() && store.crs().kind() == CrsKind::geographic)
    origin.xyz.head<2>() = middle_direction(some);
  // Whole metres: poses without a height count as on this plane.
  origin.xyz.z() = known > 0 ? std::round(heights / known) : 0;
  return origin;
}

std::vector<localization::MapLandmark> map_landmarks(const std::vector<Landmark>& landmarks,
                                                     const TypeRegistry& types, const LocalFrame& frame,
                                                     const SensorProfile* sensor) {
  std::vector<localization::MapLandmark> all;
  for (const Landmark& l : landmarks)
    all.push_back(localization::map_landmark(l, types[l.type], frame, sensor));
  return all;
}

geodb::MapQuery::Box box_in_crs(const Eigen::AlignedBox2d& box, const LocalFrame& frame) {
  const auto low = frame.crs_from_map_frame({{box.min().x(), box.min().y(), 0}}).xyz;
  geodb::MapQuery::Box all{low.x(), low.y(), low.x(), low.y()};
  for (const double x : {box.min().x(), box.max().x()})
    for (const double y : {box.min().y(), box.max().y()}) {
      const auto corner = frame.crs_from_map_frame({{x, y, 0}}).xyz;
      all = {std::min(all.min_x, corner.x()), std::min(all.min_y, corner.y()),
             std::max(all.max_x, corner.x()), std::max(all.max_y, corner.y())};
    }
  return all;
}

/// Returns true for an unknown covariance (NaN), too: there is nothing to repair.
bool is_sound_or_unknown(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d c = covariance.topLeftCorner<2, 2>();
  return c.array().isNaN().all() || is_covariance(c);
}

/// Returns the median standard deviation, m, of an imported map's landmarks along their shorter axes. What a
/// survey states is mostly the error of its positioning, which neighbours share. Maps made from observations
/// have covariances of their own: 0.
double survey_sd(const geodb::MapStore& store) {
  const std::vector<geodb::RunRecord> runs = store.runs();
  if (runs.empty() || runs.front().report_json.find("\"import_table\"") == std::string::npos) return 0;
  std::vector<double> all;
  for (const Landmark& l : store.query({.limit = 10000})) {
    const Eigen::Matrix2d c = l.covariance.topLeftCorner<2, 2>();
    const double variance = c.trace() / 2 - std::hypot((c(0, 0) - c(1, 1)) / 2, c(0, 1));
    all.push_back(variance > 0 ? std::sqrt(variance) : 0);
  }
  if (all.empty()) return 0;
  const auto middle = all.begin() + std::ssize(all) / 2;
  std::ranges::nth_element(all, middle);
  return *middle;
}

/// Returns the types that have a landmark of that confidence.
std::vector<TypeId> held_types(const geodb::MapStore& store, double min_confidence) {
  std::vector<TypeId> held;
  for (TypeId type = 0; type < store.types().size(); ++type)
    if (!store.query({.types = {store.types()[type].name}, .min_confidence = min_confidence, .limit = 1})
             .empty())
      held.push_back(type);
  return held;
}

/// Tiles of a DEM, read when the robot reaches them.
class DemTiles {
 public:
  DemTiles(std::shared_ptr<const DemSource> dem, const LocalFrame& frame, const Crs& map_crs)
      : dem_(std::move(dem)), frame_(frame) {
    if (!dem_->geometry().where.crs.same_as(map_crs))
      to_dem_ = std::make_shared<CrsTransform>(map_crs, dem_->geometry().where.crs);
  }

  // The ground does not lie on the tangent plane: at its height the vertical has left the point of the plane.
  std::optional<double> operator()(const Eigen::Vector2d& place) {
    const Eigen::Vector3d plane = frame_.crs_from_map_frame({{place.x(), place.y(), 0}}).xyz;
    const auto height = height_at(plane);
    if (!height || frame_.crs().kind() == CrsKind::local) return height;
    return height_at(frame_.crs_from_map_frame({{place.x(), place.y(), *height - plane.z()}}).xyz);
  }

 private:
  std::optional<double> height_at(const Eigen::Vector3d& at) {
    CrsTransform::XY in_dem{at.x(), at.y()};
    if (to_dem_) in_dem = (*to_dem_)(at.x(), at.y());
    const GridGeometry& g = dem_->geometry();
    const double c = g.where.column(in_dem.x), r = g.where.row(in_dem.y);
    if (!(c >= 0 && r >= 0 && c < static_cast<double>(g.columns) && r < static_cast<double>(g.rows)))
      return {};
    const double c0 = std::floor(c), r0 = std::floor(r), u = c - c0, v = r - r0;
    const auto column = static_cast<std::int64_t>(c0), row = static_cast<std::int64_t>(r0);
    const double h = (1 - v) * ((1 - u) * cell(column, row) + u * cell(column + 1, row)) +
                     v * ((1 - u) * cell(column, row + 1) + u * cell(column + 1, row + 1));
    if (!std::isfinite(h)) return {};
    return h;
  }

  static constexpr std::int64_t kTile = 512;

  double cell(std::int64_t column, std::int64_t row) {
    const std::int64_t tile_column = column / kTile, tile_row = row / kTile;
    const auto key = std::pair(tile_column, tile_row);
    if (key != last_ || !tile_) {
      auto [found, fresh] = tiles_.try_emplace(key);
      if (fresh) found->second = dem_->read({tile_column * kTile, tile_row * kTile, kTile, kTile});
      last_ = key;
      tile_ = &found->second;
    }
    return (*tile_)(column - tile_column * kTile, row - tile_row * kTile);
  }

  std::shared_ptr<const DemSource> dem_;
  LocalFrame frame_;
  std::shared_ptr<CrsTransform> to_dem_;
  std::map<std::pair<std::int64_t, std::int64_t>, HeightWindow> tiles_;
  std::pair<std::int64_t, std::int64_t> last_;
  const HeightWindow* tile_ = nullptr;
};

}  // namespace

std::shared_ptr<const DemSource> open_dem(const RobotMap& map, const std::vector<std::string>& dem_files) {
  std::vector<std::string> files = dem_files;
  if (files.empty()) {
    if (!map.store->has_dem_coverage()) return {};
    files = {"GPKG:" + map.store->path().string() + ":dem"};
  }
  return importers::import_dem({.files = files,
                                .nodata = NodataPolicy::unknown,
                                .crs = map.crs().kind() == CrsKind::local ? "local" : "",
                                .inspect = false});
}

localization::TerrainHeight open_terrain(const RobotMap& map, const std::vector<std::string>& dem_files) {
  const std::shared_ptr<const DemSource> dem = open_dem(map, dem_files);
  if (!dem) return {};
  const auto tiles = std::make_shared<DemTiles>(dem, map.frame, map.crs());
  return [tiles](const Eigen::Vector2d& place) { return (*tiles)(place); };
}

std::vector<localization::MapLandmark> all_landmarks(const RobotMap& map, const SensorProfile* sensor,
                                                     std::int64_t max_count) {
  if (map.landmarks > max_count) return {};
  return map_landmarks(map.store->query({.min_confidence = map.min_confidence}), map.types(), map.frame,
                       sensor);
}

OpenedMap make_empty_robot_map() try {
  const LockedFolder folder(std::filesystem::temp_directory_path());  // the open file outlives it
  const std::filesystem::path file = folder.path() / "none.gpkg";
  geodb::MapContents contents;
  contents.types = all_types();
  geodb::write_map(file, contents);
  return open_robot_map(file.string(), nullptr, true);
} catch (const std::filesystem::filesystem_error& e) {
  throw Error(ErrorCode::environment, "cannot make a folder for an empty map: " + e.code().message(),
              e.path1().string(), "set TMPDIR to a folder that can be written");
}

OpenedMap open_robot_map(const std::string& file, const SensorProfile* sensor, bool may_be_empty,
                         double min_confidence) {
  const auto store = std::make_shared<const geodb::MapStore>(geodb::MapStore::open(file));
  RobotMap map{.store = store,
               .frame = LocalFrame(store->crs(), frame_origin(*store)),
               .landmarks = store->count(),
               .held_types = held_types(*store, min_confidence),
               .min_confidence = min_confidence,
               .unsound_covariances = 0,
               .survey_sd = survey_sd(*store),
               .bounds = {}};
  if (map.landmarks == 0 && !may_be_empty)
    throw Error(ErrorCode::input, "the map has no landmarks: there is nothing to find the way by", file,
                "give a map with landmarks; `waymark localize --method odometry` needs none");
  if (map.landmarks <= kMaxReadAtOnce || map.crs().kind() == CrsKind::geographic) {
    const std::vector<Landmark> all = store->query({.min_confidence = min_confidence});
    if (all.empty() && !may_be_empty)
      throw Error(ErrorCode::input,
                  fmt::format("the map has no landmark of confidence {:g} or more", min_confidence), file,
                  "lower --min-confidence");
    map.unsound_covariances =
        std::ranges::count_if(all, [](const Landmark& l) { return !is_sound_or_unknown(l.covariance); });
    localization::LandmarkGrid grid(map_landmarks(all, store->types(), map.frame, sensor));
    map.bounds = grid.bounds();
    return {map, localization::LandmarkWindow(std::move(grid))};
  }
  const LocalFrame frame = map.frame;
  localization::LandmarkSource source = [store, frame, sensor,
                                         min_confidence](const Eigen::AlignedBox2d& box) {
    return map_landmarks(store->query({.box = box_in_crs(box, frame), .min_confidence = min_confidence}),
                         store->types(), frame, sensor);
  };
  return {map, localization::LandmarkWindow(std::move(source), kMargin)};
}

}  // namespace waymark::workflows
