// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/pose_steps.hpp"

#include "core/byte_layout.hpp"
#include "importers/hash.hpp"
#include "pipeline/reconstruction/reconstruction_codec.hpp"

namespace waymark::workflows {
namespace {

std::string hash_of(const std::string& file) {
  return file.empty() ? "" : importers::hash_file(file).sha256;
}

std::string key_of_matches(const Photos& photos, const PhotoFeatures& found,
                           const std::vector<pipeline::ImageToMatch>& images) {
  ByteWriter key;
  ByteLayout<ByteWriter> io(key);
  io.list(found.fingerprints, [&](const std::string& fingerprint) { io(fingerprint); });
  io.list(images, [&](const pipeline::ImageToMatch& image) {
    io(image.name, image.lens);
    io.maybe(image.position, [&](const Eigen::Vector3d& position) { io.matrix(position); });
    io.maybe(image.time, [&](const double& time) { io(time); });
  });
  io.list(photos.unused, [&](const UnusedPhoto& photo) { io(photo.name, photo.reason); });
  pipeline::ImageMatches lenses;
  lenses.lenses = photos.lenses;
  key(pipeline::Codec<pipeline::ImageMatches>::encode(lenses));
  return key.take();
}

// Each layout serves both directions; `value` is const when it is written.
constexpr auto kLadderStep = [](auto& io, auto& step) {
  io(step.lens, step.parameter, step.admitted, step.value, step.sd, step.prior_value, step.prior_sd,
     step.contradicts, step.correlation, step.correlated_with, step.left_out_before, step.left_out_after,
     step.reason);
};

constexpr auto kControl = [](auto& io, auto& point) {
  io(point.name, point.check, point.used);
  io.maybe(point.position, [&](auto& position) { io.matrix(position); });
  io.maybe(point.covariance, [&](auto& covariance) { io.matrix(covariance); });
  io.matrix(point.error);
  io(point.mark_rms, point.statistic, point.note);
};

constexpr auto kPosed = [](auto& io, auto& value) {
  using Scene = pipeline::Codec<pipeline::Reconstruction>;
  if constexpr (std::remove_cvref_t<decltype(io)>::reads) {
    std::string scene;
    io(scene);
    value.scene = Scene::decode(scene);
  } else {
    io(Scene::encode(value.scene));
  }
  io(value.crs, value.posed, value.gps_rms, value.components, value.pairs_tried, value.pairs_matched);
  io.list(value.messages, [&](auto& message) { io(message); });
  io.list(value.failures, [&](auto& failure) { io(failure.name, failure.reason); });
  io.list(value.ladder, [&](auto& step) { kLadderStep(io, step); });
  io.list(value.control, [&](auto& point) { kControl(io, point); });
};

}  // namespace

PoseSteps pose_steps(const PosePhotosRequest& request, const Photos& photos, const PhotoFeatures& found,
                     const std::vector<pipeline::ImageToMatch>& images, const pipeline::KeptResults& kept) {
  PoseSteps steps{.matches = {.name = "match_images", .item = "all", .version = 2, .depends_on = ""},
                  .solved = {.name = "solve_poses", .item = "all", .version = 4, .depends_on = ""},
                  .poses = {.name = "georeference", .item = "all", .version = 3, .depends_on = ""}};
  if (!kept.enabled()) return steps;
  steps.matches.depends_on = key_of_matches(photos, found, images);
  steps.solved.depends_on = steps.matches.fingerprint();
  ByteWriter references;
  references(steps.solved.fingerprint());
  for (const std::string& file :
       {request.control, request.marks, request.altimeter, request.dem, request.map_image})
    references(hash_of(file));
  references(request.crs);
  steps.poses.depends_on = references.take();
  return steps;
}

}  // namespace waymark::workflows

namespace waymark::pipeline {

std::string Codec<workflows::PosedPhotos>::encode(const workflows::PosedPhotos& value) {
  return bytes_of(value, workflows::kPosed);
}
workflows::PosedPhotos Codec<workflows::PosedPhotos>::decode(std::string_view bytes) {
  return value_of<workflows::PosedPhotos>(bytes, workflows::kPosed);
}

}  // namespace waymark::pipeline
