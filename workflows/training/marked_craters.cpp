// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/marked_craters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "importers/images/image.hpp"
#include "pipeline/craters/filled_image.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "workflows/evaluation/scored_table.hpp"

namespace waymark::workflows {
namespace {

/// Scales other pixels than those of eight bits to 0 to 255, for which the views of a training are made; the
/// darkest and the brightest thousandth are clipped. Without data: the surroundings.
Pixels as_eight_bits(const Pixels& image, const ImageInfo& info) {
  Pixels scaled = pipeline::fill_holes(image).pixels;
  if (info.saturated == 255) return scaled;
  std::vector<float> values(scaled.cells().begin(), scaled.cells().end());
  const auto quantile = [&](double fraction) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  const float low = quantile(0.001), high = std::max(quantile(0.999), std::nextafter(low, HUGE_VALF));
  for (float& value : scaled.cells()) value = std::clamp(255 * (value - low) / (high - low), 0.0F, 255.0F);
  return scaled;
}

}  // namespace

pipeline::LabelledScene read_marked_craters(const std::string& image_and_table) {
  const std::size_t comma = image_and_table.rfind(',');
  if (comma == std::string::npos)
    throw Error(ErrorCode::usage, fmt::format("'{}' names no table of craters", image_and_table),
                "train craters", "give --labels IMAGE,TABLE");
  const std::string path = image_and_table.substr(0, comma), table = image_and_table.substr(comma + 1);
  const auto image = importers::import_image(path, {.georeference = false});
  const ImageInfo& info = image->info();
  pipeline::LabelledScene scene;
  scene.image = as_eight_bits(image->read({0, 0, info.columns, info.rows}), info);
  for (const auto& [type, marked] : read_scored_things(table, "", 0))
    for (const testbed::EvaluatedObject& one : marked) {
      const double x = one.at.x(), y = one.at.y();
      if (!(one.diameter > 0))
        throw Error(ErrorCode::input, fmt::format("the crater at {:g}, {:g} has no diameter", x, y), table);
      if (!(x >= -0.5 && y >= -0.5 && x < double(info.columns) - 0.5 && y < double(info.rows) - 0.5))
        throw Error(ErrorCode::input,
                    fmt::format("the crater at {:g}, {:g} lies outside the image of {} x {} pixels", x, y,
                                info.columns, info.rows),
                    table, "positions are pixels, x to the right, y down");
      scene.craters.push_back({x, y, one.diameter});
    }
  if (info.image_sun_angle) {
    scene.sun_angle = to_radians(*info.image_sun_angle);
  } else if (const auto light = pipeline::estimate_crater_sun_angle(scene.image)) {
    scene.sun_angle = light->angle;
  } else {
    throw Error(ErrorCode::input, "the image does not show where its light comes from", path,
                "train on images with more craters");
  }
  return scene;
}

}  // namespace waymark::workflows
