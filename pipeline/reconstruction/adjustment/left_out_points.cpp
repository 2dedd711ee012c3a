// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/left_out_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "pipeline/reconstruction/adjustment/triangulate.hpp"

namespace waymark::pipeline {
namespace {

// Fowler, Noll and Vo's hash of bytes.
std::uint64_t hash(const std::string& text, double x, double y) {
  std::uint64_t value = 14695981039346656037u;
  const auto add = [&](std::uint64_t byte) { value = (value ^ byte) * 1099511628211u; };
  for (const char c : text) add(static_cast<unsigned char>(c));
  for (const double number : {x, y})
    for (int shift = 0; shift < 64; shift += 8) add(std::bit_cast<std::uint64_t>(number) >> shift & 255);
  return value;
}

}  // namespace

SplitPoints split_points(const Reconstruction& scene) {
  constexpr std::uint64_t kEvery = 5;
  SplitPoints out;
  for (const TiePoint& point : scene.points) {
    if (point.marks.empty()) continue;
    const auto key = [&](const Mark& m) {
      return std::tuple<const std::string&, double, double>(scene.images[m.image].name, m.pixel.x(),
                                                            m.pixel.y());
    };
    const Mark& first =
        *std::ranges::min_element(point.marks, [&](const Mark& a, const Mark& b) { return key(a) < key(b); });
    const bool left = hash(scene.images[first.image].name, first.pixel.x(), first.pixel.y()) % kEvery == 0;
    (left ? out.left_out : out.kept).push_back(point);
  }
  return out;
}

double left_out_residual(const Reconstruction& scene, const std::vector<TiePoint>& left_out) {
  double sum = 0, count = 0;
  for (const TiePoint& point : left_out) {
    const auto marks = std::ranges::count_if(
        point.marks, [&](const Mark& m) { return scene.images[m.image].world_from_camera.has_value(); });
    const auto found = triangulate(scene, point.marks);
    if (!found) continue;
    const double scalars = 2 * static_cast<double>(marks), redundancy = scalars - 3;
    const double each = found->rms * found->rms * scalars / redundancy;
    sum += redundancy * std::log1p(each);
    count += redundancy;
  }
  return count > 0 ? std::sqrt(std::expm1(sum / count)) : 0;
}

}  // namespace waymark::pipeline
