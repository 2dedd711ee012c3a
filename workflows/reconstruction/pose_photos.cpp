// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_photos.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <numbers>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/cameras/camera_file.hpp"
#include "pipeline/reconstruction/adjustment/georeference.hpp"
#include "pipeline/reconstruction/adjustment/lens_ladder.hpp"
#include "pipeline/reconstruction/poses/solve_poses.hpp"
#include "workflows/reconstruction/photo_priors.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kFewFeatures = 60;

// Reports at most some steps, from one thread at a time.
class StageProgress {
 public:
  StageProgress(const Callbacks& callbacks, std::string stage, std::size_t total)
      : callbacks_(callbacks), stage_(std::move(stage)), total_(total) {}
  void step() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (callbacks_.progress)
      callbacks_.progress(
          {.stage = stage_, .done = double(done_), .total = static_cast<std::int64_t>(total_), .rate = 0});
  }

 private:
  const Callbacks& callbacks_;
  std::string stage_;
  std::size_t total_, done_ = 0;
  std::mutex mutex_;
};

struct FoundFeatures {
  std::vector<pipeline::ImageFeatures> features;
  std::vector<std::string> faults;  // by image; empty: none
};

std::string fault_of(const ReducedPixels& image, const pipeline::ImageFeatures& features) {
  if (features.features.size() >= kFewFeatures) return "";
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float v : image.pixels.cells())
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(high > low)) return "all its pixels have one value: leave it out";
  return fmt::format("it has only {} distinct points: it is blurred, dark or without texture; leave it out",
                     features.features.size());
}

FoundFeatures find_all_features(const Photos& photos, const PosePhotosRequest& request,
                                const Callbacks& callbacks) {
  FoundFeatures out{std::vector<pipeline::ImageFeatures>(photos.photos.size()),
                    std::vector<std::string>(photos.photos.size())};
  StageProgress progress(callbacks, "read_folder", photos.photos.size());
  tbb::parallel_for(
      std::size_t{0}, photos.photos.size(),
      [&](std::size_t i) {
        try {
          const ReducedPixels image = read_reduced(photos.photos[i], request.max_pixels);
          out.features[i] = pipeline::find_features(image.pixels, {.saturated = photos.photos[i].saturated});
          out.faults[i] = fault_of(image, out.features[i]);
          for (pipeline::Feature& f : out.features[i].features) {
            f.pixel = image.factor * (f.pixel.array() + 0.5) - 0.5;
            f.scale *= image.factor;
          }
        } catch (const Error& error) {
          out.faults[i] = error.problem();
        }
        progress.step();
      },
      tbb::simple_partitioner());
  return out;
}

// Metres about the first position, to choose neighbours only.
std::vector<pipeline::ImageToMatch> to_match(const Photos& photos) {
  std::vector<pipeline::ImageToMatch> images;
  std::optional<importers::PhotoPosition> origin;
  for (const Photo& photo : photos.photos) {
    pipeline::ImageToMatch image{.name = photo.name, .lens = photo.lens};
    if (const auto& at = photo.metadata.position) {
      if (!origin) origin = at;
      const double metres = 111'000, shrink = std::cos(at->lat * std::numbers::pi / 180);
      image.position =
          Eigen::Vector3d((at->lon - origin->lon) * metres * shrink, (at->lat - origin->lat) * metres,
                          photo.metadata.height_above_takeoff.value_or(0));
    }
    images.push_back(std::move(image));
  }
  return images;
}

[[noreturn]] void refuse_without_poses(const Photos& photos, const FoundFeatures& found,
                                       const pipeline::ImageMatches& matches) {
  std::size_t turned = 0;
  for (const pipeline::MatchedPair& pair : matches.pairs)
    turned += pair.geometry.kind == pipeline::PairKind::rotation;
  const std::size_t faults =
      photos.photos.size() - static_cast<std::size_t>(std::ranges::count(found.faults, ""));
  std::string hint = "take images that overlap by 60 % and show the same points from different places";
  std::string problem =
      fmt::format("none of {} images could be oriented: no two of them match", photos.photos.size());
  if (turned > 0) {
    problem = fmt::format("none of {} images could be oriented: the {} pairs that match show no parallax",
                          photos.photos.size(), turned);
    hint = "the images are copies, or were taken from one place; move the camera between them";
  } else if (faults > 0) {
    const auto first = std::ranges::find_if(found.faults, [](const std::string& f) { return !f.empty(); });
    const std::string& name = photos.photos[static_cast<std::size_t>(first - found.faults.begin())].name;
    hint = fmt::format("{} images are faulty, e.g. {}: {}", faults, name, *first);
  }
  throw Error(ErrorCode::input, problem, photos.photos[0].path, hint);
}

// Names of the lens parameters that the adjustment may free: none of a lens that is given.
std::vector<std::vector<std::string>> admitted_parameters(const pipeline::CalibratedAdjustment& calibrated,
                                                          std::size_t lenses) {
  std::vector<std::vector<std::string>> free(lenses);
  for (const pipeline::LadderStep& step : calibrated.steps)
    if (step.admitted) free[step.lens].push_back(step.parameter);
  return free;
}

// Self-calibration starts at the lens that was guessed, so that a parameter that is not admitted keeps its
// prior.
pipeline::CalibratedAdjustment calibrate(pipeline::Reconstruction& scene,
                                         const std::vector<pipeline::LensGuess>& lenses) {
  pipeline::Observations observations;
  observations.lenses = pipeline::PoseGrowth::lens_priors(lenses);
  if (std::ranges::all_of(lenses, [](const pipeline::LensGuess& lens) { return !(lens.focal_sd > 0); }))
    return {.adjustment = pipeline::adjust(scene, observations), .steps = {}, .priors = observations.lenses};
  for (std::size_t lens = 0; lens < lenses.size(); ++lens) scene.lenses[lens].camera = lenses[lens].camera;
  return pipeline::adjust_with_ladder(scene, observations);
}

// Moves the scene into a CRS by the positions of the pictures, if they have any.
void georeference_by_positions(PosedPhotos& posed, const Photos& photos,
                               const pipeline::CalibratedAdjustment& calibrated, const std::string& crs,
                               const Callbacks& callbacks) {
  const PhotoPriors priors = photo_priors(photos, crs);
  pipeline::Observations observations;
  observations.lenses = calibrated.priors;
  observations.height_bias_sd = PriorAccuracy{}.height_bias;
  for (const pipeline::ObservedPosition& p : priors.positions)
    if (posed.scene.images[p.image].world_from_camera) observations.positions.push_back(p);
  for (const pipeline::ObservedAttitude& a : priors.attitudes)
    if (posed.scene.images[a.image].world_from_camera) observations.attitudes.push_back(a);
  if (observations.positions.size() < 3) {
    posed.messages.push_back(
        fmt::format("{} posed images have a GPS position; three not in line are needed for a metric frame",
                    observations.positions.size()));
    return;
  }
  pipeline::Reconstruction moved = posed.scene;
  const pipeline::Georeferenced result = pipeline::georeference(
      moved, observations,
      {.free_lens_parameters = admitted_parameters(calibrated, posed.scene.lenses.size())});
  for (const std::string& message : result.messages) posed.messages.push_back(message);
  if (!result.metric) return;
  posed.scene = std::move(moved);
  posed.crs = priors.crs;
  double squares = 0;
  std::size_t used = 0, looking_up = 0;
  for (const pipeline::ObservationResult& seen : result.adjustment.others)
    if (seen.kind == "position" && seen.used) {
      squares += seen.error.head<2>().squaredNorm();
      ++used;
    }
  for (const pipeline::AdjustedImage& image : posed.scene.images)
    looking_up += image.world_from_camera && image.world_from_camera->linear()(2, 2) > 0.5;
  posed.gps_rms = used > 0 ? std::sqrt(squares / double(used)) : 0;
  if (2 * looking_up > posed.posed || posed.gps_rms > 30 || 2 * used < observations.positions.size())
    callbacks.warning(fmt::format(
        "the GPS positions do not fit the images: {} of {} agree, with {:.1f} m RMS, and {} cameras "
        "look up; check that latitude and longitude are not exchanged and the hemispheres right",
        used, observations.positions.size(), posed.gps_rms, looking_up));
}

struct ResidualSummary {
  double rms = 0;  // pixels
  std::size_t marks = 0, points = 0;
};

std::vector<exporters::SparsePoint> sparse_points(const pipeline::Reconstruction& scene,
                                                  ResidualSummary& summary) {
  std::vector<exporters::SparsePoint> points;
  double all = 0;
  for (const pipeline::TiePoint& tie : scene.points) {
    if (!tie.position) continue;
    exporters::SparsePoint point{.position = *tie.position};
    double squares = 0;
    for (const pipeline::Mark& m : tie.marks) {
      const pipeline::AdjustedImage& image = scene.images[m.image];
      if (!image.world_from_camera) continue;
      const auto seen = project(scene.lenses[image.lens].camera,
                                Point<CameraFrame>{image.world_from_camera->inverse() * *tie.position});
      if (!seen) continue;
      squares += (*seen - m.pixel).squaredNorm();
      point.marks.push_back({m.image, m.pixel});
    }
    if (point.marks.size() < 2) continue;
    point.error = std::sqrt(squares / double(2 * point.marks.size()));
    if (tie.covariance)
      point.sd = std::sqrt(tie.covariance->selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff());
    all += squares;
    summary.marks += point.marks.size();
    points.push_back(std::move(point));
  }
  summary.points = points.size();
  summary.rms = summary.marks > 0 ? std::sqrt(all / double(2 * summary.marks)) : 0;
  return points;
}

exporters::CameraFileContent camera_content(const PosedPhotos& posed, const Photos& photos) {
  exporters::CameraFileContent content;
  if (!posed.crs.empty()) content.crs = posed.crs;
  for (const pipeline::AdjustedLens& lens : posed.scene.lenses) content.lenses.push_back(lens.camera);
  for (std::size_t i = 0; i < posed.scene.images.size(); ++i) {
    const pipeline::AdjustedImage& image = posed.scene.images[i];
    content.images.push_back({.name = image.name,
                              .lens = image.lens,
                              .world_from_camera = image.world_from_camera,
                              .covariance = image.covariance,
                              .taken_utc = photos.photos[i].taken_utc});
  }
  return content;
}

void write_products(const PosedPhotos& posed, const Photos& photos,
                    const std::vector<exporters::SparsePoint>& points, const fs::path& folder) {
  const exporters::CameraFileContent content = camera_content(posed, photos);
  write_file(folder / "cameras.json", exporters::camera_file_text(content));
  write_file(folder / "points.ply", exporters::ply_text(points));
  std::error_code failed;
  fs::create_directories(folder / "colmap", failed);
  if (failed) fail_output(folder / "colmap", failed.message());
  const exporters::ColmapModel model = exporters::colmap_model(content, points);
  write_file(folder / "colmap" / "cameras.txt", model.cameras);
  write_file(folder / "colmap" / "images.txt", model.images);
  write_file(folder / "colmap" / "points3D.txt", model.points);
}

std::string lens_line(const pipeline::AdjustedLens& lens, std::size_t index, std::size_t images) {
  const Camera& c = lens.camera;
  std::string text =
      fmt::format("  lens {}: {} images of {} x {}, f {:.2f} px", index + 1, images, c.columns, c.rows, c.fx);
  for (std::size_t k = 0; k < lens.parameters.size(); ++k) {
    const double sd = std::sqrt(lens.covariance(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)));
    text += fmt::format("{} {} +- {:.2g}", k == 0 ? "; adjusted:" : ",", lens.parameters[k], sd);
  }
  return text + (lens.parameters.empty() ? "; kept fixed\n" : "\n");
}

// Largest axis of the error ellipsoid of each centre.
double median_centre_sd(const pipeline::Reconstruction& scene) {
  std::vector<double> all;
  for (const pipeline::AdjustedImage& image : scene.images)
    if (image.covariance)
      all.push_back(std::sqrt(image.covariance->bottomRightCorner<3, 3>()
                                  .selfadjointView<Eigen::Lower>()
                                  .eigenvalues()
                                  .maxCoeff()));
  if (all.empty()) return 0;
  std::ranges::sort(all);
  return all[all.size() / 2];
}

std::string table_of(const PosedPhotos& posed, const Photos& photos, const pipeline::ImageMatches& matches,
                     const ResidualSummary& residuals) {
  std::string text = fmt::format("{} of {} images posed", posed.posed, photos.photos.size());
  if (posed.components.size() > 1)
    text += fmt::format("; the images form {} groups without common points: {}", posed.components.size(),
                        fmt::join(posed.components, ", "));
  text += fmt::format("\n  {} of {} pairs matched; {} tie points, {:.1f} marks each\n", matches.pairs.size(),
                      matches.tried, residuals.points,
                      residuals.points > 0 ? double(residuals.marks) / double(residuals.points) : 0.0);
  text += fmt::format("  residuals {:.2f} px RMS, sigma0 {:.2f}\n", residuals.rms, posed.scene.sigma0);
  for (std::size_t lens = 0; lens < posed.scene.lenses.size(); ++lens) {
    const auto images = static_cast<std::size_t>(std::ranges::count_if(
        posed.scene.images,
        [&](const pipeline::AdjustedImage& i) { return i.lens == lens && i.world_from_camera; }));
    text += lens_line(posed.scene.lenses[lens], lens, images);
  }
  if (!posed.crs.empty())
    text +=
        fmt::format("  frame: {}; residuals of GPS {:.2f} m RMS in plan; median sd of the centres {:.3f} m\n",
                    posed.crs, posed.gps_rms, median_centre_sd(posed.scene));
  for (const std::string& message : posed.messages) text += fmt::format("  {}\n", message);
  if (posed.crs.empty()) text += "  frame: arbitrary position, direction and scale\n";
  for (const UnusedPhoto& failure : posed.failures)
    text += fmt::format("  not posed: {}: {}\n", failure.name, failure.reason);
  return text;
}

}  // namespace

PosedPhotos pose_photos(const PosePhotosRequest& request, const Callbacks& callbacks) {
  std::optional<tbb::global_control> limit;
  if (request.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(request.threads));
  const Photos photos = read_photos({.images = request.images, .lens = request.lens}, callbacks);
  const FoundFeatures found = find_all_features(photos, request, callbacks);
  const std::vector<pipeline::ImageToMatch> images = to_match(photos);
  pipeline::ImageMatching matching;
  matching.progress = [&, mutex = std::make_shared<std::mutex>()](std::size_t done, std::size_t all) {
    const std::lock_guard lock(*mutex);
    if (callbacks.progress)
      callbacks.progress({.stage = "match_images",
                          .done = double(done),
                          .total = static_cast<std::int64_t>(all),
                          .rate = 0});
  };
  const pipeline::ImageMatches matches =
      pipeline::match_images(images, found.features, photos.lenses, matching);
  pipeline::SolvedPoses solved = pipeline::solve_poses(images, found.features, matches, {});
  if (solved.components.empty()) refuse_without_poses(photos, found, matches);
  PosedPhotos out;
  for (const pipeline::SolvedComponent& component : solved.components)
    out.components.push_back(component.posed);
  out.scene = std::move(solved.components[0].scene);
  for (const pipeline::AdjustedImage& image : out.scene.images)
    out.posed += image.world_from_camera.has_value();
  const pipeline::CalibratedAdjustment calibrated = calibrate(out.scene, matches.lenses);
  for (const pipeline::LadderStep& step : calibrated.steps)
    if (!step.admitted)
      out.messages.push_back(fmt::format("lens {}: {} stays at {:.6g}: {}", step.lens + 1, step.parameter,
                                         step.value, step.reason));
  georeference_by_positions(out, photos, calibrated, request.crs, callbacks);
  out.failures = photos.unused;
  for (std::size_t i = 0; i < out.scene.images.size(); ++i) {
    if (out.scene.images[i].world_from_camera) continue;
    std::string reason =
        !found.faults[i].empty() ? found.faults[i]
        : !solved.failures[i].empty()
            ? solved.failures[i]
            : "it belongs to a smaller group of images, which shares no points with the largest";
    out.failures.push_back({photos.photos[i].name, std::move(reason)});
  }
  ResidualSummary residuals;
  const std::vector<exporters::SparsePoint> points = sparse_points(out.scene, residuals);
  write_products(out, photos, points, request.folder);
  callbacks.summary(table_of(out, photos, matches, residuals));
  return out;
}

}  // namespace waymark::workflows
