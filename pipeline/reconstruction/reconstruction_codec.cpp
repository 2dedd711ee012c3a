// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/reconstruction_codec.hpp"

#include "core/byte_layout.hpp"

namespace waymark::pipeline {
namespace {

// Each layout serves both directions; `value` is const when it is written.

constexpr auto kCamera = [](auto& io, auto& camera) {
  io(camera.columns, camera.rows, camera.fx, camera.fy, camera.cx, camera.cy, camera.skew, camera.lens);
  io(camera.distortion);
};

constexpr auto kFeatures = [](auto& io, auto& value) {
  io.list(value.features, [&](auto& feature) {
    io.matrix(feature.pixel);
    io(feature.scale, feature.angle);
  });
  io(value.descriptors);
};

constexpr auto kPair = [](auto& io, auto& pair) {
  io(pair.images.first, pair.images.second);
  auto& geometry = pair.geometry;
  io(geometry.kind);
  io(geometry.inliers, geometry.angles, geometry.homography_inliers);
  io.list(geometry.poses, [&](auto& pose) { io.matrix(pose.rotation), io.matrix(pose.direction); });
};

constexpr auto kMatches = [](auto& io, auto& value) {
  io.list(value.pairs, [&](auto& pair) { kPair(io, pair); });
  io.list(value.lenses, [&](auto& lens) {
    kCamera(io, lens.camera);
    io(lens.focal_sd, lens.readout_time);
  });
  // std::vector<bool> has no addressable items.
  std::vector<std::uint8_t> voted(value.voted.begin(), value.voted.end());
  io(voted, value.tried);
  if constexpr (std::remove_cvref_t<decltype(io)>::reads) value.voted.assign(voted.begin(), voted.end());
};

constexpr auto kReconstruction = [](auto& io, auto& scene) {
  io(scene.frame, scene.sigma0);
  io.list(scene.lenses, [&](auto& lens) {
    kCamera(io, lens.camera);
    io.list(lens.parameters, [&](auto& name) { io(name); });
    io.matrix(lens.covariance);
    io(lens.readout_time);
  });
  io.list(scene.images, [&](auto& image) {
    io(image.name, image.lens, image.component);
    io.maybe(image.world_from_camera, [&](auto& pose) { io.matrix(pose.matrix()); });
    io.maybe(image.covariance, [&](auto& covariance) { io.matrix(covariance); });
    io.maybe(image.time, [&](auto& time) { io(time); });
    io.maybe(image.motion, [&](auto& motion) { io.matrix(motion.shift), io.matrix(motion.turn); });
  });
  io.list(scene.points, [&](auto& point) {
    io.list(point.marks, [&](auto& mark) {
      io(mark.image, mark.sd);
      io.matrix(mark.pixel);
    });
    io.maybe(point.position, [&](auto& position) { io.matrix(position); });
    io.maybe(point.covariance, [&](auto& covariance) { io.matrix(covariance); });
  });
};

constexpr auto kSolved = [](auto& io, auto& value) {
  io.list(value.components, [&](auto& component) {
    kReconstruction(io, component.scene);
    io(component.posed);
  });
  io.list(value.failures, [&](auto& failure) { io(failure); });
};

constexpr auto kHeights = [](auto& io, auto& value) {
  io(value.window.column, value.window.row, value.window.columns, value.window.rows);
  io(value.height, value.sd, value.score, value.angle, value.gsd, value.views, value.reason, value.block);
  io.list(value.blocks, [&](auto& chosen) {
    io(chosen.views);
    io(chosen.pairs, chosen.pairs_in_halves, chosen.gsd, chosen.angle, chosen.candidates);
  });
};

}  // namespace

std::string Codec<ImageFeatures>::encode(const ImageFeatures& value) {
  return bytes_of(value, kFeatures);
}
ImageFeatures Codec<ImageFeatures>::decode(std::string_view bytes) {
  return value_of<ImageFeatures>(bytes, kFeatures);
}

std::string Codec<ImageMatches>::encode(const ImageMatches& value) {
  return bytes_of(value, kMatches);
}
ImageMatches Codec<ImageMatches>::decode(std::string_view bytes) {
  return value_of<ImageMatches>(bytes, kMatches);
}

std::string Codec<Reconstruction>::encode(const Reconstruction& value) {
  return bytes_of(value, kReconstruction);
}
Reconstruction Codec<Reconstruction>::decode(std::string_view bytes) {
  return value_of<Reconstruction>(bytes, kReconstruction);
}

std::string Codec<SolvedPoses>::encode(const SolvedPoses& value) {
  return bytes_of(value, kSolved);
}
SolvedPoses Codec<SolvedPoses>::decode(std::string_view bytes) {
  return value_of<SolvedPoses>(bytes, kSolved);
}

std::string Codec<ChunkHeights>::encode(const ChunkHeights& value) {
  return bytes_of(value, kHeights);
}
ChunkHeights Codec<ChunkHeights>::decode(std::string_view bytes) {
  return value_of<ChunkHeights>(bytes, kHeights);
}

}  // namespace waymark::pipeline
