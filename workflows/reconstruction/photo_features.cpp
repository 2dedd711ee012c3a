// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_features.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/bytes.hpp"
#include "core/error.hpp"
#include "importers/hash.hpp"
#include "pipeline/engine/progress_meter.hpp"
#include "pipeline/reconstruction/reconstruction_codec.hpp"

namespace waymark::workflows {
namespace {

constexpr std::size_t kFewFeatures = 60;

std::string fault_of(const ReducedPixels& image, const pipeline::ImageFeatures& features) {
  if (features.features.size() >= kFewFeatures) return "";
  float low = std::numeric_limits<float>::infinity(), high = -low;
  for (const float v : image.pixels.cells())
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(high > low)) return "all its pixels have one value: leave it out";
  return fmt::format("it has only {} distinct points: it is blurred, dark or without texture; leave it out",
                     features.features.size());
}

// Features in pixels of the file; adds the fault of a picture that is of no use.
pipeline::ImageFeatures features_of(const Photo& photo, double max_pixels, std::vector<std::string>& faults) {
  const ReducedPixels image = read_reduced(photo, max_pixels);
  pipeline::ImageFeatures found = pipeline::find_features(image.pixels, {.saturated = photo.saturated});
  if (std::string fault = fault_of(image, found); !fault.empty()) faults.push_back(std::move(fault));
  for (pipeline::Feature& f : found.features) {
    f.pixel = image.factor * (f.pixel.array() + 0.5) - 0.5;
    f.scale *= image.factor;
  }
  return found;
}

pipeline::KeptStep step_of(const Photo& photo, double max_pixels, const pipeline::KeptResults& kept) {
  pipeline::KeptStep step{.name = "find_features", .item = photo.name, .version = 1, .depends_on = ""};
  if (!kept.enabled()) return step;
  ByteWriter key;
  key(importers::hash_file(photo.path).sha256);
  key(max_pixels), key(photo.saturated);
  step.depends_on = key.take();
  return step;
}

}  // namespace

PhotoFeatures find_photo_features(const Photos& photos, double max_pixels, const pipeline::KeptResults& kept,
                                  const Callbacks& callbacks) {
  const std::size_t count = photos.photos.size();
  PhotoFeatures out{std::vector<pipeline::ImageFeatures>(count), std::vector<std::string>(count),
                    std::vector<std::string>(count)};
  pipeline::ProgressMeter meter(callbacks.progress, "read_folder",
                                static_cast<std::int64_t>(photos.photos.size()));
  tbb::parallel_for(
      std::size_t{0}, photos.photos.size(),
      [&](std::size_t i) {
        try {
          const pipeline::KeptStep step = step_of(photos.photos[i], max_pixels, kept);
          std::vector<std::string> faults;
          out.features[i] = kept.get<pipeline::ImageFeatures>(
              step,
              [&](std::vector<std::string>& found) {
                return features_of(photos.photos[i], max_pixels, found);
              },
              faults);
          if (!faults.empty()) out.faults[i] = faults.front();
          if (kept.enabled()) out.fingerprints[i] = step.fingerprint();
        } catch (const Error& error) {
          out.faults[i] = error.problem();
        }
        meter.add(1);
      },
      tbb::simple_partitioner());
  meter.finish();
  return out;
}

std::vector<pipeline::ImageToMatch> images_to_match(const Photos& photos) {
  std::vector<pipeline::ImageToMatch> images;
  std::optional<importers::PhotoPosition> origin;
  for (const Photo& photo : photos.photos) {
    pipeline::ImageToMatch image{.name = photo.name, .lens = photo.lens, .time = photo.time};
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

}  // namespace waymark::workflows
