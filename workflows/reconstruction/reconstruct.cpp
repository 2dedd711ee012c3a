// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/reconstruct.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "importers/tables/area_of_interest.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
#include "workflows/output_path.hpp"
#include "workflows/reconstruction/coarse_dem.hpp"
#include "workflows/reconstruction/map_image.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
#include "workflows/reconstruction/posed_images.hpp"
#include "workflows/reconstruction/report_reconstruction.hpp"
#include "workflows/reconstruction/surface_products.hpp"
#include "workflows/reconstruction/sweep_steps.hpp"

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
  if (!request.cameras.empty() && !request.marks.empty())
    throw Error(ErrorCode::usage, "--marks and --cameras are both given, but marks serve to solve the poses",
                "",
                "leave out --cameras; or tie its poses to the map by --control TABLE "
                "(docs/how_to/tie_cameras_to_the_map.md)");
  if (request.cameras.empty() && !request.camera_crs.empty())
    throw Error(ErrorCode::usage, "--camera-crs is given, but no camera file whose positions are in it", "",
                "pass --cameras FILE, or --crs for the map");
  if (!request.cameras.empty() && !request.altimeter.empty())
    throw Error(
        ErrorCode::usage,
        "--altimeter and --cameras are both given, but heights of an altimeter serve to solve the poses", "",
        "leave out one or the other");
  if (!request.cameras.empty() && !request.map_image.empty())
    throw Error(ErrorCode::usage,
                "--map and --cameras are both given, but the map image serves to place solved poses", "",
                "leave out --cameras or --map");
  if (!request.map_image.empty()) check_map_image(request.map_image, request.crs);
  if (!(request.readout_time >= 0 && request.readout_time <= 10))
    throw Error(ErrorCode::usage,
                fmt::format("--readout-time {} is no time from row to row", request.readout_time), "",
                "pass seconds from the first row to the last: 0 (global shutter) to 10");
  if (!request.cameras.empty() && request.readout_time > 0)
    throw Error(ErrorCode::usage,
                "--readout-time and --cameras are both given, but the readout time serves to solve the poses",
                "", "leave out one or the other");
  if (request.control.empty() && !request.marks.empty())
    throw Error(ErrorCode::usage, "--marks is given, but no control points", "", "pass --control FILE");
  if (!request.aoi.empty() && request.until == ReconstructUntil::poses)
    throw Error(ErrorCode::usage, "--aoi limits DEM and orthophoto, but --until poses makes none", "",
                "leave out one or the other");
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

// DEM, bands and orthophoto are held in memory: 85 bytes a cell were measured.
void check_memory(double cells, double cell) {
  constexpr double kBytesPerCell = 100;
  const double needed = kBytesPerCell * cells + static_cast<double>(kImageBytes);
  const double present =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  if (!(present > 0) || needed <= present) return;
  const double fitting = std::max(1.0, (present - static_cast<double>(kImageBytes)) / kBytesPerCell);
  throw Error(
      ErrorCode::usage,
      fmt::format("a DEM of {:.0f} million cells needs {:.1f} GB of memory, but the machine has {:.1f} GB",
                  cells / 1e6, needed / 1e9, present / 1e9),
      "",
      fmt::format("pass --cell {:.2g} or larger, or reconstruct parts of the images",
                  cell * std::sqrt(cells / fitting)));
}

/// Leaves the cells of the box around the area.
void crop_to_area(const std::string& aoi, const Crs& crs, pipeline::SurfaceGrid& grid) {
  const double metres = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  const Eigen::AlignedBox2d box = importers::read_area_of_interest(aoi, crs).box();
  const auto cells = [](double at, std::int64_t count) {
    return static_cast<std::int64_t>(std::clamp(at, 0.0, static_cast<double>(count)));
  };
  const std::int64_t left = cells(std::floor((box.min().x() * metres - grid.west) / grid.cell), grid.columns),
                     right = cells(std::ceil((box.max().x() * metres - grid.west) / grid.cell), grid.columns),
                     top = cells(std::floor((grid.north - box.max().y() * metres) / grid.cell), grid.rows),
                     bottom = cells(std::ceil((grid.north - box.min().y() * metres) / grid.cell), grid.rows);
  if (right - left < 2 || bottom - top < 2)
    throw Error(ErrorCode::input, "the area of interest does not meet the terrain that two images see", aoi,
                fmt::format("they see x {:.1f} to {:.1f}, y {:.1f} to {:.1f} in {}", grid.west / metres,
                            (grid.west + static_cast<double>(grid.columns) * grid.cell) / metres,
                            (grid.north - static_cast<double>(grid.rows) * grid.cell) / metres,
                            grid.north / metres, crs.id()));
  grid.west += static_cast<double>(left) * grid.cell;
  grid.north -= static_cast<double>(top) * grid.cell;
  grid.columns = right - left, grid.rows = bottom - top;
}

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
  auto grid = cell > 0 ? pipeline::overlap_grid(views, plan.range, cell) : std::nullopt;
  if (!grid)
    throw Error(ErrorCode::input,
                fmt::format("no two images see the same terrain between {:.1f} and {:.1f} m", plan.range.low,
                            plan.range.high),
                request.cameras, "check the poses: cameras must look down at heights below them");
  if (!request.aoi.empty()) crop_to_area(request.aoi, posed.crs, *grid);
  const double cells = static_cast<double>(grid->columns) * static_cast<double>(grid->rows);
  if (cells > kMaxCells)
    throw Error(ErrorCode::usage, fmt::format("--cell {:g} makes {:.0f} million cells", cell, cells / 1e6),
                "", fmt::format("pass a cell of {:.2g} m or more", cell * std::sqrt(cells / kMaxCells)));
  check_memory(cells, cell);
  plan.grid = *grid;
  return plan;
}

double median_height(const pipeline::SurfaceHeights& dem) {
  std::vector<float> heights;
  for (const float h : dem.height.cells())
    if (!std::isnan(h)) heights.push_back(h);
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::ranges::nth_element(heights, middle);
  return static_cast<double>(*middle);
}

/// Poses in hand: solved or given.
struct PosesInHand {
  PosedImages images = {};
  std::size_t posed = 0, failed = 0;
  std::string crs = {};  ///< empty: the frame is arbitrary
  exporters::ReconstructionReport report = {};
};

void write_report_page(const fs::path& folder, const exporters::ReconstructionReport& report) {
  write_file(folder / "report.html", exporters::reconstruction_page(report));
}

PosedPhotos solve_poses_of(const ReconstructRequest& request, const Callbacks& callbacks) {
  PosedPhotos made = pose_photos(request, callbacks);
  write_report_page(request.folder, report_of_poses(made));
  const std::string cameras = (fs::path(request.folder) / "cameras.json").string();
  if (made.crs.empty() && !request.control.empty())
    throw Error(ErrorCode::input,
                "the control points do not give the frame: " +
                    (made.messages.empty() ? std::string("too few are seen") : made.messages.back()),
                request.control, fmt::format("the poses in an arbitrary frame are in {}", cameras));
  if (made.crs.empty() && request.until != ReconstructUntil::poses)
    throw Error(ErrorCode::input, "heights need poses in metres, but the frame of the poses is arbitrary",
                cameras,
                "pass --control POINTS, --map MAP_IMAGE, --dem COARSE or --altimeter TABLE, or tie the "
                "cameras to the map "
                "(docs/how_to/tie_cameras_to_the_map.md) and pass them by --cameras, or pass --until poses");
  return made;
}

PosesInHand solved_poses(const ReconstructRequest& request, const Callbacks& callbacks) {
  const PosedPhotos made = solve_poses_of(request, callbacks);
  PosesInHand out{
      .posed = made.posed, .failed = made.failures.size(), .crs = made.crs, .report = report_of_poses(made)};
  if (request.until == ReconstructUntil::poses) return out;
  out.images = read_posed_images({.images = request.images,
                                  .cameras = (fs::path(request.folder) / "cameras.json").string(),
                                  .crs = request.crs},
                                 callbacks);
  for (const pipeline::TiePoint& point : made.scene.points)
    if (point.position) out.images.points.push_back(*point.position);
  return out;
}

PosesInHand given_poses(const ReconstructRequest& request, const Callbacks& callbacks) {
  CameraTie tie = request;
  tie.control_points = request.control;
  PosesInHand out{
      .images = read_posed_images(
          {.images = request.images, .cameras = request.cameras, .crs = request.crs, .tie = tie}, callbacks)};
  out.posed = out.images.images.size();
  out.failed = out.images.unposed.size();
  out.crs = out.images.crs.id();
  out.report = report_of_cameras(out.images, 0);
  const fs::path file = fs::path(request.folder) / "cameras.json";
  write_file(file, camera_file(out.images));
  callbacks.summary(fmt::format("{}: {} images with poses\n", file.string(), out.posed));
  return out;
}

pipeline::SurfaceHeights measure_heights(const ReconstructRequest& request, const PosedImages& posed,
                                         const std::vector<pipeline::SurfaceView>& views,
                                         const Callbacks& callbacks) {
  pipeline::SweepPlan plan = plan_sweep(request, posed, views);
  pipeline::ProgressMeter meter(callbacks.progress, "sweep_heights", 100);
  double reported = 0;
  plan.progress = [&](double done) { meter.add(100 * (done - std::exchange(reported, done))); };
  const pipeline::KeptResults kept(request.work);
  keep_chunks(plan, views, kept);
  pipeline::SurfaceHeights dem = pipeline::sweep_heights(views, plan);
  meter.finish();
  const std::int64_t cells = dem.grid.columns * dem.grid.rows;
  if (static_cast<double>(dem.kept()) < kMinKept * static_cast<double>(cells) || dem.kept() == 0)
    throw Error(ErrorCode::input,
                fmt::format("{} of {} cells of the DEM have a height: the images share hardly any terrain",
                            dem.kept(), cells),
                request.cameras, "check overlap, poses and lens; reasons: " + reasons_text(dem));
  const fs::path file = fs::path(request.folder) / "dem.tif";
  write_dem(file, dem, posed.crs);
  callbacks.summary(fmt::format("{}: {} x {} cells of {:.3g} m, {:.1f} % measured\n  not measured: {}\n",
                                file.string(), dem.grid.columns, dem.grid.rows, dem.grid.cell,
                                100 * static_cast<double>(dem.kept()) / static_cast<double>(cells),
                                reasons_text(dem)));
  return dem;
}

pipeline::Orthophoto make_ortho(const ReconstructRequest& request, const PosedImages& posed,
                                const std::vector<pipeline::SurfaceView>& views,
                                const pipeline::SurfaceHeights& dem, const Callbacks& callbacks) {
  constexpr int kPixelsPerCell = 2;
  pipeline::ProgressMeter meter(callbacks.progress, "orthophoto", 100);
  pipeline::Orthophoto ortho = pipeline::make_orthophoto(
      views, dem.grid, dem.height, kPixelsPerCell, kImageBytes, [&](double part) { meter.add(100 * part); });
  meter.finish();
  const fs::path file = fs::path(request.folder) / "orthophoto.tif";
  write_orthophoto(file, ortho, views, posed.crs);
  callbacks.summary(fmt::format("{}: {} x {} pixels of {:.3g} m\n", file.string(), ortho.grid.columns,
                                ortho.grid.rows, ortho.grid.cell));
  return ortho;
}

}  // namespace

ReconstructResult reconstruct(const ReconstructRequest& request, const Callbacks& callbacks) {
  check_request(request);
  const fs::path folder = request.folder;
  make_output_folder(folder);
  PosesInHand poses =
      request.cameras.empty() ? solved_poses(request, callbacks) : given_poses(request, callbacks);
  ReconstructResult result{.images = poses.posed, .failed = poses.failed, .crs = poses.crs};
  write_report_page(folder, poses.report);
  if (poses.failed > 0)
    callbacks.send(MessageKind::failure,
                   fmt::format("{} of {} images have no pose; {} names them with the reasons", poses.failed,
                               poses.posed + poses.failed, (folder / "report.html").string()));
  if (request.until == ReconstructUntil::poses) return result;

  const std::vector<pipeline::SurfaceView> views = pipeline::surface_views(poses.images.images);
  const pipeline::SurfaceHeights dem = measure_heights(request, poses.images, views, callbacks);
  result.cells = dem.grid.columns * dem.grid.rows;
  result.kept = dem.kept();
  if (!request.cameras.empty()) poses.report = report_of_cameras(poses.images, median_height(dem));
  poses.report.surface = reported_surface(dem, {});
  write_report_page(folder, poses.report);
  if (request.until == ReconstructUntil::dem) return result;

  poses.report.surface = reported_surface(dem, make_ortho(request, poses.images, views, dem, callbacks));
  write_report_page(folder, poses.report);
  write_file(folder / "job.json", job_text(poses.images, dem, folder));
  if (request.map.empty()) return result;
  result.map = make_map(load_job(folder / "job.json"),
                        {.map = request.map,
                         .run = {.work = request.work, .threads = request.threads},
                         .command_line = request.command_line},
                        callbacks);
  return result;
}

}  // namespace waymark::workflows
