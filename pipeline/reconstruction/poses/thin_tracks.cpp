// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/poses/thin_tracks.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace waymark::pipeline {
namespace {

constexpr std::size_t kSide = 8;

std::size_t cell_of(const Mark& mark, const Camera& camera) {
  const auto part = [](double at, std::int64_t size) {
    return static_cast<std::size_t>(std::clamp(at / double(size) * double(kSide), 0.0, double(kSide - 1)));
  };
  return part(mark.pixel.y(), camera.rows) * kSide + part(mark.pixel.x(), camera.columns);
}

double mean_sd(const TiePoint& point) {
  double sum = 0;
  for (const Mark& m : point.marks) sum += m.sd;
  return sum / double(point.marks.size());
}

}  // namespace

std::vector<std::size_t> thin_tracks(std::span<const TiePoint> tracks, const Reconstruction& images,
                                     std::size_t per_image) {
  const std::size_t per_cell = std::max<std::size_t>(1, per_image / (kSide * kSide));
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) {
    return std::tuple(-static_cast<std::ptrdiff_t>(tracks[i].marks.size()), mean_sd(tracks[i]), i);
  });
  std::vector<std::array<std::size_t, kSide * kSide>> filled(images.images.size());
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    bool needed = false;
    for (const Mark& m : tracks[i].marks)
      needed |= filled[m.image][cell_of(m, images.lenses[images.images[m.image].lens].camera)] < per_cell;
    if (!needed) continue;
    for (const Mark& m : tracks[i].marks)
      ++filled[m.image][cell_of(m, images.lenses[images.images[m.image].lens].camera)];
    chosen.push_back(i);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace waymark::pipeline
