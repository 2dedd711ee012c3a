// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_photos.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "core/error.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/reconstruction/poses/solve_poses.hpp"
#include "pipeline/reconstruction/reconstruction_codec.hpp"
#include "workflows/reconstruction/georeference_photos.hpp"
#include "workflows/reconstruction/photo_control.hpp"
#include "workflows/reconstruction/photo_features.hpp"
#include "workflows/reconstruction/pose_products.hpp"
#include "workflows/reconstruction/pose_steps.hpp"
#include "workflows/reconstruction/pose_summary.hpp"

namespace waymark::workflows {
namespace {

[[noreturn]] void refuse_without_poses(const Photos& photos, const PhotoFeatures& found,
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

// Self-calibration starts at the lens that was guessed, so that a parameter that is not admitted keeps its
// prior.
pipeline::CalibratedAdjustment calibrate(pipeline::Reconstruction& scene,
                                         const std::vector<pipeline::LensGuess>& lenses,
                                         const Callbacks& callbacks) {
  pipeline::Observations observations;
  observations.lenses = pipeline::PoseGrowth::lens_priors(lenses);
  if (std::ranges::all_of(lenses, [](const pipeline::LensGuess& lens) { return !(lens.focal_sd > 0); }))
    return {.adjustment = pipeline::adjust(scene, observations), .steps = {}, .priors = observations.lenses};
  for (std::size_t lens = 0; lens < lenses.size(); ++lens) scene.lenses[lens].camera = lenses[lens].camera;
  std::size_t groups = 2;  // adjustments before and after
  for (const pipeline::AdjustedLens& lens : scene.lenses) groups += pipeline::ladder_groups(lens.camera);
  pipeline::ProgressMeter meter(callbacks.progress, "calibrate_lens", static_cast<std::int64_t>(groups));
  std::size_t done = 0;
  pipeline::LadderOptions ladder;
  ladder.progress = [&] {
    if (++done < groups) meter.add(1);
  };
  pipeline::CalibratedAdjustment calibrated = pipeline::adjust_with_ladder(scene, observations, {}, ladder);
  meter.add(double(groups) - double(std::min(done, groups - 1)));
  meter.finish();
  return calibrated;
}

pipeline::ImageMatches match_photos(const std::vector<pipeline::ImageToMatch>& images,
                                    const PhotoFeatures& found, const Photos& photos,
                                    const Callbacks& callbacks) {
  std::optional<pipeline::ProgressMeter> meter;
  pipeline::ImageMatching matching;
  matching.progress = [&, once = std::make_shared<std::once_flag>()](std::size_t, std::size_t all) {
    std::call_once(
        *once, [&] { meter.emplace(callbacks.progress, "match_images", static_cast<std::int64_t>(all)); });
    meter->add(1);
  };
  pipeline::ImageMatches matches = pipeline::match_images(images, found.features, photos.lenses, matching);
  if (meter) meter->finish();
  return matches;
}

pipeline::SolvedPoses solve_photo_poses(const std::vector<pipeline::ImageToMatch>& images,
                                        const PhotoFeatures& found, const pipeline::ImageMatches& matches,
                                        const Callbacks& callbacks) {
  pipeline::ProgressMeter meter(callbacks.progress, "solve_poses", static_cast<std::int64_t>(images.size()));
  std::size_t furthest = 0;  // of several starts
  pipeline::PoseSettings settings;
  settings.progress = [&](std::size_t posed) {
    if (posed > furthest) meter.add(double(posed - furthest)), furthest = posed;
  };
  pipeline::SolvedPoses solved = pipeline::solve_poses(images, found.features, matches, settings);
  meter.finish();
  return solved;
}

std::vector<UnusedPhoto> failures_of(const Photos& photos, const PhotoFeatures& found,
                                     const pipeline::SolvedPoses& solved,
                                     const pipeline::Reconstruction& scene) {
  std::vector<UnusedPhoto> failures = photos.unused;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (scene.images[i].world_from_camera) continue;
    std::string reason =
        !found.faults[i].empty() ? found.faults[i]
        : !solved.failures[i].empty()
            ? solved.failures[i]
            : "it belongs to a smaller group of images, which shares no points with the largest";
    failures.push_back({photos.photos[i].name, std::move(reason)});
  }
  return failures;
}

// Self-calibration and georeference of the largest component.
PosedPhotos place_poses(const PosePhotosRequest& request, const Photos& photos,
                        const SurveyedReferences& surveyed, const PhotoFeatures& found,
                        const pipeline::ImageMatches& matches, pipeline::SolvedPoses solved,
                        const Callbacks& callbacks) {
  PosedPhotos out;
  for (const pipeline::SolvedComponent& component : solved.components)
    out.components.push_back(component.posed);
  out.scene = std::move(solved.components[0].scene);
  out.pairs_matched = matches.pairs.size();
  out.pairs_tried = matches.tried;
  for (const pipeline::AdjustedImage& image : out.scene.images)
    out.posed += image.world_from_camera.has_value();
  const pipeline::CalibratedAdjustment calibrated = calibrate(out.scene, matches.lenses, callbacks);
  out.ladder = calibrated.steps;
  for (const pipeline::LadderStep& step : calibrated.steps)
    if (step.contradicts)
      out.messages.push_back(fmt::format(
          "lens {}: {} is {:.6g} by the images, but {:.6g} by their metadata, which are not used; "
          "check that EXIF has the values of this lens",
          step.lens + 1, step.parameter, step.value, step.prior_value));
  for (const pipeline::LadderStep& step : calibrated.steps)
    if (!step.admitted)
      out.messages.push_back(fmt::format("lens {}: {} stays at {:.6g}: {}", step.lens + 1, step.parameter,
                                         step.value, step.reason));
  pipeline::ProgressMeter meter(callbacks.progress, "georeference", 1);
  georeference_photos(out, photos, surveyed, calibrated, request, callbacks);
  meter.add(1);
  meter.finish();
  out.failures = failures_of(photos, found, solved, out.scene);
  return out;
}

}  // namespace

PosedPhotos pose_photos(const PosePhotosRequest& request, const Callbacks& callbacks) {
  std::optional<tbb::global_control> limit;
  if (request.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(request.threads));
  const Photos photos = read_photos(
      {.images = request.images, .lens = request.lens, .readout_time = request.readout_time}, callbacks);
  SurveyedReferences surveyed;
  if (!request.control.empty())
    surveyed.control =
        photo_control({.points = request.control, .marks = request.marks, .crs = request.crs}, photos);
  if (!request.altimeter.empty()) surveyed.altimeter = photo_altimeter(request.altimeter, photos);
  const pipeline::KeptResults kept(request.work);
  const PhotoFeatures found = find_photo_features(photos, request.max_pixels, kept, callbacks);
  const std::vector<pipeline::ImageToMatch> images = images_to_match(photos);
  const PoseSteps steps = pose_steps(request, photos, found, images, kept);
  std::vector<std::string> warnings;
  PosedPhotos out = kept.get<PosedPhotos>(
      steps.poses,
      [&](std::vector<std::string>& said) {
        const Callbacks recording{.progress = callbacks.progress, .message = [&](const Message& message) {
                                    if (message.kind == MessageKind::warning)
                                      said.push_back(message.text);
                                    else
                                      callbacks.send(message.kind, message.text);
                                  }};
        const auto matches = kept.get<pipeline::ImageMatches>(
            steps.matches, [&] { return match_photos(images, found, photos, recording); });
        auto solved = kept.get<pipeline::SolvedPoses>(
            steps.solved, [&] { return solve_photo_poses(images, found, matches, recording); });
        if (solved.components.empty()) refuse_without_poses(photos, found, matches);
        return place_poses(request, photos, surveyed, found, matches, std::move(solved), recording);
      },
      warnings);
  for (const std::string& warning : warnings) callbacks.warning(warning);
  const std::vector<exporters::SparsePoint> points = sparse_points(out.scene);
  write_pose_products(out, photos, points, request.folder);
  callbacks.summary(pose_summary(out, points));
  return out;
}

}  // namespace waymark::workflows
