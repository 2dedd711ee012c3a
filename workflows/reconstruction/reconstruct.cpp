// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/reconstruct.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/raster/cog_file.hpp"
#include "geo/crs.hpp"
#include "importers/rasters/dem.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
#include "workflows/output_path.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
#include "workflows/reconstruction/posed_images.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;

void check_request(const ReconstructRequest& request) {
  if (request.folder.empty())
    throw Error(ErrorCode::usage, "no folder is given for the products", "", "pass -o DIR");
  if (request.cameras.empty() && request.images.empty())
    throw Error(ErrorCode::usage, "neither images nor poses are given", "",
                "name a folder of images, or pass --cameras FILE");
  if (!request.cameras.empty() && !request.lens.empty())
    throw Error(ErrorCode::usage, "--lens and --cameras are both given, but poses come with their lens", "",
                "leave out --lens");
  if (!(request.cell >= 0 && std::isfinite(request.cell)))
    throw Error(ErrorCode::usage, fmt::format("--cell {} is not a size in metres", request.cell), "",
                "pass a number above 0, or leave it out");
  if (!request.map.empty()) {
    if (request.until != ReconstructUntil::ortho)
      throw Error(ErrorCode::usage, "--map-landmarks needs all products, but --until stops before them", "",
                  "leave out one or the other");
    check_map_output(request.map);
  }
}

void make_output_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) fail_output(folder, failed.message());
}

pipeline::CoarseHeights read_coarse_dem(const std::string& file, const PosedImages& posed) {
  constexpr int kNodes = 256;  // across
  importers::DemImport import{.files = {file}, .nodata = NodataPolicy::unknown, .inspect = false};
  if (posed.crs.kind() == CrsKind::local) import.crs = "local";
  const auto dem = importers::import_dem(import);
  const GridGeometry& geometry = dem->geometry();
  const Georeference& where = geometry.where;
  const bool same = where.crs.same_as(posed.crs);
  std::optional<CrsTransform> transform;
  if (!same) transform.emplace(posed.crs, where.crs);
  const double unit = posed.crs.kind() == CrsKind::local ? 1 : posed.crs.metres_per_unit();
  const auto height = [&](double x, double y) {
    const CrsTransform::XY at =
        same ? CrsTransform::XY{x / unit, y / unit} : (*transform)(x / unit, y / unit);
    const double c = where.column(at.x), r = where.row(at.y);
    if (!(std::abs(c) < 1e9 && std::abs(r) < 1e9)) return kNoHeight;
    const auto i = static_cast<std::int64_t>(std::floor(c)), j = static_cast<std::int64_t>(std::floor(r));
    const HeightWindow cells = dem->read({i, j, 2, 2});
    const double a = c - double(i), b = r - double(j);
    return (1 - b) * ((1 - a) * cells(0, 0) + a * cells(1, 0)) +
           b * ((1 - a) * cells(0, 1) + a * cells(1, 1));
  };

  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  double above = 0;
  bool covered = false;
  for (const ImageHandle& image : posed.images) {
    const Eigen::Vector3d centre = image->info().view->centre().xyz;
    low = low.cwiseMin(centre.head<2>());
    high = high.cwiseMax(centre.head<2>());
    const double below = height(centre.x(), centre.y());
    if (!std::isfinite(below)) continue;
    covered = true;
    if (!(centre.z() > below))
      throw Error(
          ErrorCode::input,
          fmt::format("image {} lies {:.1f} m below the coarse DEM", image->info().name, below - centre.z()),
          file,
          "heights of cameras and DEM may refer to different zeros (geoid, ellipsoid, take-off): shift one "
          "of "
          "them");
    above = std::max(above, centre.z() - below);
  }
  if (!covered)
    throw Error(
        ErrorCode::input, "the coarse DEM has no height below any of the images", file,
        fmt::format("the cameras lie between x {:.1f} and {:.1f}, y {:.1f} and {:.1f} in {}: check --crs",
                    low.x() / unit, high.x() / unit, low.y() / unit, high.y() / unit, posed.crs.id()));
  const double width = (high - low).maxCoeff() + 4 * above;
  pipeline::CoarseHeights coarse{.grid = {.west = (low.x() + high.x() - width) / 2,
                                          .north = (low.y() + high.y() + width) / 2,
                                          .cell = width / kNodes,
                                          .columns = kNodes,
                                          .rows = kNodes},
                                 .heights = Grid<float>(kNodes, kNodes),
                                 .sd = dem->height_sd()};
  for (std::int64_t r = 0; r < kNodes; ++r)
    for (std::int64_t c = 0; c < kNodes; ++c) {
      const double h = height(coarse.grid.x(double(c)), coarse.grid.y(double(r)));
      coarse.heights(c, r) =
          std::isfinite(h) ? static_cast<float>(h) : std::numeric_limits<float>::quiet_NaN();
    }
  return coarse;
}

std::string reasons_text(const pipeline::SurfaceHeights& heights) {
  std::vector<std::pair<std::int64_t, int>> order;
  for (int i = 1; i < pipeline::kNoHeightReasons; ++i)
    if (heights.counts[static_cast<std::size_t>(i)] > 0)
      order.emplace_back(-heights.counts[static_cast<std::size_t>(i)], i);
  std::ranges::sort(order);
  std::string text;
  for (const auto& [count, reason] : order)
    text += fmt::format(
        "{}{} {:.1f} %", text.empty() ? "" : ", ",
        pipeline::reason_text(static_cast<pipeline::NoHeight>(reason)),
        -100 * static_cast<double>(count) / static_cast<double>(heights.grid.columns * heights.grid.rows));
  return text;
}

/// Returns images whose pixels all have the same value, or none: lens caps, black frames.
std::vector<std::string> flat_images(const std::vector<pipeline::SurfaceView>& views,
                                     pipeline::ImageLevels& images) {
  std::vector<std::string> flat;
  for (std::size_t v = 0; v < views.size(); ++v) {
    float low = std::numeric_limits<float>::infinity(), high = -low;
    for (const float value : images.get(v, 3)->pixels.cells())
      if (!std::isnan(value)) low = std::min(low, value), high = std::max(high, value);
    if (!(high > low)) flat.push_back(views[v].name);
  }
  return flat;
}

constexpr double kMinKept = 0.01;  // of the cells; with less the heights are chance
constexpr std::size_t kImageBytes = std::size_t{1} << 30;

pipeline::SweepPlan plan_sweep(const ReconstructRequest& request, const PosedImages& posed,
                               const std::vector<pipeline::SurfaceView>& views) {
  constexpr double kMaxCells = 4e8;
  pipeline::SweepPlan plan{.image_bytes = kImageBytes};
  if (!request.dem.empty()) {
    plan.coarse = read_coarse_dem(request.dem, posed);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const float h : plan.coarse->heights.cells())
      if (!std::isnan(h))
        low = std::min(low, static_cast<double>(h)), high = std::max(high, static_cast<double>(h));
    plan.range = {low, high};
  } else {
    pipeline::ImageLevels images(views, kImageBytes);
    const auto points = posed.points.empty() ? pipeline::probe_heights(views, images) : posed.points;
    const auto range = pipeline::height_range(points);
    if (!range) {
      const std::vector<std::string> flat = flat_images(views, images);
      if (!flat.empty())
        throw Error(ErrorCode::input,
                    fmt::format("{} of {} images have no contrast", flat.size(), views.size()),
                    request.folder, fmt::format("remove black and covered images: {}", flat.front()));
      throw Error(
          ErrorCode::input,
          fmt::format("no terrain was found that two of the {} images share: {} points agree, 10 are needed",
                      views.size(), points.size()),
          request.cameras,
          "check that the images overlap and that poses, lens and CRS are right; --dem gives the heights to "
          "start at");
    }
    plan.range = *range;
  }
  const double gsd = pipeline::usual_gsd(views, (plan.range.low + plan.range.high) / 2);
  const double cell = request.cell > 0 ? request.cell : 2 * gsd;
  const auto grid = cell > 0 ? pipeline::overlap_grid(views, plan.range, cell) : std::nullopt;
  if (!grid)
    throw Error(ErrorCode::input,
                fmt::format("no two images see the same terrain between {:.1f} and {:.1f} m", plan.range.low,
                            plan.range.high),
                request.cameras, "check the poses: cameras must look down at heights below them");
  const double cells = static_cast<double>(grid->columns) * static_cast<double>(grid->rows);
  if (cells > kMaxCells)
    throw Error(ErrorCode::usage, fmt::format("--cell {:g} makes {:.0f} million cells", cell, cells / 1e6),
                "", fmt::format("pass a cell of {:.2g} m or more", cell * std::sqrt(cells / kMaxCells)));
  plan.grid = *grid;
  return plan;
}

Georeference map_reference(const Crs& crs, const pipeline::SurfaceGrid& grid) {
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  return {crs, grid.x(0) / unit, grid.y(0) / unit, grid.cell / unit, -grid.cell / unit};
}

Grid<float> as_floats(const Grid<std::uint8_t>& cells) {
  Grid<float> out(cells.columns(), cells.rows());
  std::ranges::transform(cells.cells(), out.cells().begin(),
                         [](std::uint8_t v) { return static_cast<float>(v); });
  return out;
}

void write_dem(const fs::path& file, const pipeline::SurfaceHeights& dem, const Crs& crs) {
  std::map<std::string, std::string> reasons;
  for (int i = 0; i < pipeline::kNoHeightReasons; ++i)
    reasons[fmt::format("REASON_{}", i)] = pipeline::reason_text(static_cast<pipeline::NoHeight>(i));
  const Grid<float> views = as_floats(dem.views), reason = as_floats(dem.reason);
  exporters::write_cog(file,
                       {{"height", "m", &dem.height},
                        {"standard deviation of matching", "m", &dem.sd},
                        {"standard deviation of poses and lens", "m", &dem.systematic_sd},
                        {"views", "", &views},
                        {"convergence angle", "deg", &dem.angle},
                        {"score", "", &dem.score},
                        {"reason of no data", "", &reason}},
                       map_reference(crs, dem.grid), reasons);
}

void write_orthophoto(const fs::path& file, const pipeline::Orthophoto& ortho,
                      const std::vector<pipeline::SurfaceView>& views, const Crs& crs) {
  Grid<float> source(ortho.source.columns(), ortho.source.rows());
  std::ranges::transform(ortho.source.cells(), source.cells().begin(), [](std::uint16_t v) {
    return v == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(v);
  });
  std::map<std::string, std::string> names;
  for (std::size_t v = 0; v < views.size(); ++v) {
    names[fmt::format("SOURCE_{}", v + 1)] = views[v].name;
    names[fmt::format("GAIN_{}", v + 1)] = fmt::format("{:.4f}", ortho.gains[v]);
  }
  exporters::write_cog(file, {{"brightness", "", &ortho.brightness}, {"index of source", "", &source}},
                       map_reference(crs, ortho.grid), names);
}

// Path from the folder of the job, so that folder and images can be moved together; /vsi paths as they are.
std::string path_from(const fs::path& folder, const std::string& file) {
  if (file.starts_with("/vsi")) return file;
  return fs::absolute(file)
      .lexically_normal()
      .lexically_proximate(fs::absolute(folder).lexically_normal())
      .string();
}

std::string job_text(const PosedImages& posed, const pipeline::SurfaceHeights& dem, const fs::path& folder) {
  using JobJson = nlohmann::ordered_json;
  std::vector<float> sds;
  for (const float sd : dem.sd.cells())
    if (!std::isnan(sd)) sds.push_back(sd);
  std::ranges::nth_element(sds, sds.begin() + static_cast<std::ptrdiff_t>(sds.size() / 2));
  JobJson load{{"stage", "load_dem"},
               {"files", {"dem.tif"}},
               {"band", 1},
               {"nodata", "unknown"},
               {"height_sd", static_cast<double>(sds[sds.size() / 2])}};
  if (posed.crs.kind() == CrsKind::local) load["crs"] = "local";
  JobJson files = JobJson::array();
  bool suns = true;
  for (const ImageHandle& image : posed.images) {
    files.push_back(path_from(folder, image->info().path));
    suns = suns && (image->info().sun || image->info().image_sun_angle);
  }
  JobJson stages = JobJson::array(
      {load, JobJson{{"stage", "load_images"}, {"files", files}, {"cameras", "cameras.json"}}});
  std::vector<const char*> names{"rocks_from_shadows", "craters_from_bowls", "project_to_ground",
                                 "reject_implausible"};
  if (suns) names.push_back("reject_terrain_shadows");
  for (const char* name :
       {"reject_rim_shadows", "align_images", "merge_observations", "value_landmarks", "find_mountain_tops",
        "join_mountain_tops", "measure_isolation", "map_mountain_tops"})
    names.push_back(name);
  for (const char* name : names) stages.push_back({{"stage", name}});
  return JobJson{{"name", "Map from pictures"}, {"stages", stages}}.dump(2) + "\n";
}

}  // namespace

ReconstructResult reconstruct(const ReconstructRequest& request, const Callbacks& callbacks) {
  check_request(request);
  const fs::path folder = request.folder;
  make_output_folder(folder);
  std::string cameras = request.cameras;
  std::size_t failed = 0;
  std::vector<Eigen::Vector3d> points;
  if (cameras.empty()) {
    const PosedPhotos made = pose_photos({.images = request.images,
                                          .folder = request.folder,
                                          .lens = request.lens,
                                          .crs = request.crs,
                                          .threads = request.threads},
                                         callbacks);
    failed = made.failures.size();
    if (request.until == ReconstructUntil::poses) return {.images = made.posed, .failed = failed};
    cameras = (folder / "cameras.json").string();
    if (made.crs.empty())
      throw Error(
          ErrorCode::input, "heights need poses in metres, but the frame of the poses is arbitrary", cameras,
          "tie the cameras to the map (docs/how_to/tie_cameras_to_the_map.md) and pass them by --cameras, or "
          "pass --until poses");
    for (const pipeline::TiePoint& point : made.scene.points)
      if (point.position) points.push_back(*point.position);
  }
  PosedImages posed =
      read_posed_images({.images = request.images, .cameras = cameras, .crs = request.crs}, callbacks);
  posed.points = std::move(points);
  ReconstructResult result{.images = posed.images.size(), .failed = failed};
  write_file(folder / "cameras.json", camera_file(posed));
  callbacks.summary(
      fmt::format("{}: {} images with poses\n", (folder / "cameras.json").string(), result.images));
  if (request.until == ReconstructUntil::poses) return result;

  const std::vector<pipeline::SurfaceView> views = pipeline::surface_views(posed.images);
  pipeline::SweepPlan plan = plan_sweep(request, posed, views);
  if (callbacks.progress)
    plan.progress = [&](double done) {
      callbacks.progress({.stage = "heights", .done = 100 * done, .total = 100});
    };
  const pipeline::SurfaceHeights dem = pipeline::sweep_heights(views, plan);
  result.cells = dem.grid.columns * dem.grid.rows;
  result.kept = dem.kept();
  if (static_cast<double>(result.kept) < kMinKept * static_cast<double>(result.cells) || result.kept == 0)
    throw Error(ErrorCode::input,
                fmt::format("{} of {} cells of the DEM have a height: the images share hardly any terrain",
                            result.kept, result.cells),
                request.cameras, "check overlap, poses and lens; reasons: " + reasons_text(dem));
  write_dem(folder / "dem.tif", dem, posed.crs);
  callbacks.summary(fmt::format("{}: {} x {} cells of {:.3g} m, {:.1f} % measured\n  not measured: {}\n",
                                (folder / "dem.tif").string(), dem.grid.columns, dem.grid.rows, dem.grid.cell,
                                100 * static_cast<double>(result.kept) / static_cast<double>(result.cells),
                                reasons_text(dem)));
  if (request.until == ReconstructUntil::dem) return result;

  constexpr int kPixelsPerCell = 2;
  const pipeline::Orthophoto ortho =
      pipeline::make_orthophoto(views, dem.grid, dem.height, kPixelsPerCell, kImageBytes);
  write_orthophoto(folder / "orthophoto.tif", ortho, views, posed.crs);
  callbacks.summary(fmt::format("{}: {} x {} pixels of {:.3g} m\n", (folder / "orthophoto.tif").string(),
                                ortho.grid.columns, ortho.grid.rows, ortho.grid.cell));
  write_file(folder / "job.json", job_text(posed, dem, folder));
  if (request.map.empty()) return result;
  result.map = make_map(
      load_job(folder / "job.json"),
      {.map = request.map, .threads = request.threads, .command_line = request.command_line}, callbacks);
  return result;
}

}  // namespace waymark::workflows
