// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace waymark::pipeline {
namespace {

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// Images of one component in the order of their times, each time once.
using Sequence = std::vector<std::size_t>;

std::vector<Sequence> sequences_of(const Reconstruction& scene) {
  std::map<std::pair<std::size_t, std::size_t>, Sequence> by_component;  // and by lens: cameras move apart
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const AdjustedImage& image = scene.images[i];
    if (image.time && image.world_from_camera && scene.lenses[image.lens].readout_time > 0)
      by_component[{image.component, image.lens}].push_back(i);
  }
  std::vector<Sequence> out;
  for (auto& [key, images] : by_component) {
    const auto time = [&](std::size_t i) { return *scene.images[i].time; };
    std::ranges::stable_sort(images, [&](std::size_t a, std::size_t b) {
      return std::pair(time(a), scene.images[a].name) < std::pair(time(b), scene.images[b].name);
    });
    const auto is_same = [&](std::size_t a, std::size_t b) { return time(a) == time(b); };
    images.erase(std::unique(images.begin(), images.end(), is_same), images.end());
    out.push_back(std::move(images));
  }
  return out;
}

/// Factors of the values at some times that give the slope of the polynomial through them at a time.
std::vector<double> slope_factors(const std::vector<double>& times, double at) {
  std::vector<double> factors(times.size(), 0);
  for (std::size_t j = 0; j < times.size(); ++j)
    for (std::size_t m = 0; m < times.size(); ++m) {
      if (m == j) continue;
      double product = 1 / (times[j] - times[m]);
      for (std::size_t n = 0; n < times.size(); ++n)
        if (n != j && n != m) product *= (at - times[n]) / (times[j] - times[n]);
      factors[j] += product;
    }
  return factors;
}

/// Centres and rotations about the axes of one image of some others.
struct Track {
  std::vector<double> times = {};
  std::vector<Eigen::Vector3d> centres = {}, turns = {};
};

Track track_of(const Reconstruction& scene, const Sequence& images, std::size_t first, std::size_t count,
               std::size_t axes_of) {
  Track track;
  const Eigen::Matrix3d axes = scene.images[axes_of].world_from_camera->linear().transpose();
  for (std::size_t k = first; k < first + count; ++k) {
    const AdjustedImage& image = scene.images[images[k]];
    track.times.push_back(*image.time);
    track.centres.push_back(image.world_from_camera->translation());
    track.turns.push_back(rotation_vector(axes * image.world_from_camera->linear()));
  }
  return track;
}

/// Third divided difference of four values: a sixth of the third derivative.
Eigen::Vector3d third_difference(const std::vector<double>& t, std::vector<Eigen::Vector3d> v) {
  for (std::size_t order = 1; order < v.size(); ++order)
    for (std::size_t i = v.size() - 1; i >= order; --i) v[i] = (v[i] - v[i - 1]) / (t[i] - t[i - order]);
  return v.back();
}

/// Error of the slope of a parabola through three times at one of them, for a third divided difference of 1.
double slope_error(const std::vector<double>& times, double at) {
  double product = 1;
  for (const double t : times)
    if (t != at) product *= std::abs(at - t);
  return product;
}

/// Root mean square of the third differences of shift and turn near an image, one component; 0: fewer than
/// four images.
std::pair<double, double> roughness_at(const Reconstruction& scene, const Sequence& images, std::size_t at) {
  double shift = 0, turn = 0, count = 0;
  for (std::size_t first = at > 4 ? at - 4 : 0; first <= at + 1 && first + 4 <= images.size(); ++first) {
    const Track four = track_of(scene, images, first, 4, images[at]);
    shift += third_difference(four.times, four.centres).squaredNorm() / 3;
    turn += third_difference(four.times, four.turns).squaredNorm() / 3;
    ++count;
  }
  return count > 0 ? std::pair(std::sqrt(shift / count), std::sqrt(turn / count)) : std::pair(0.0, 0.0);
}

/// Standard deviation of the difference of two times that are rounded to whole seconds; 0 if they are not.
double rounding_of_times(const Reconstruction& scene, const Sequence& images) {
  const bool whole = std::ranges::all_of(
      images, [&](std::size_t i) { return *scene.images[i].time == std::floor(*scene.images[i].time); });
  return whole ? std::sqrt(2.0 / 12) : 0;
}

ExpectedMotion expect(const Reconstruction& scene, const Sequence& images, std::size_t at, double rounding) {
  constexpr double kMinDeviation = 0.02;                    // of the motion
  constexpr double kSteady = 0.2 * std::numbers::pi / 180;  // rad/s that no neighbour shows: vibration
  const double readout = scene.lenses[scene.images[images[at]].lens].readout_time;
  const std::size_t count = std::min<std::size_t>(3, images.size());
  const std::size_t first = std::min(at > 0 ? at - 1 : 0, images.size() - count);
  const Track track = track_of(scene, images, first, count, images[at]);
  const double now = *scene.images[images[at]].time;
  const std::vector<double> factors = slope_factors(track.times, now);
  ExpectedMotion out;
  for (std::size_t k = 0; k < count; ++k) {
    out.centres.emplace_back(images[first + k], readout * factors[k]);
    out.motion.shift += readout * factors[k] * track.centres[k];
    out.motion.turn += readout * factors[k] * track.turns[k];
  }
  const auto [rough_shift, rough_turn] = roughness_at(scene, images, at);
  const double error = readout * slope_error(track.times, now);
  const double unsure = std::hypot(images.size() < 4 ? 1 : kMinDeviation,
                                   rounding / (track.times.back() - track.times.front()));
  out.shift_sd = std::hypot(error * rough_shift, unsure * out.motion.shift.norm());
  out.turn_sd = std::hypot(error * rough_turn, unsure * out.motion.turn.norm(), readout * kSteady);
  return out;
}

}  // namespace

Eigen::Isometry3d pose_of_mark(const Reconstruction& scene, const Mark& mark) {
  const AdjustedImage& image = scene.images.at(mark.image);
  if (!image.motion) return *image.world_from_camera;
  return moved_pose(*image.world_from_camera, *image.motion,
                    readout_fraction(scene.lenses.at(image.lens).camera, mark.pixel.y()));
}

std::vector<std::optional<ExpectedMotion>> expected_motions(const Reconstruction& scene) {
  std::vector<std::optional<ExpectedMotion>> out(scene.images.size());
  for (const Sequence& images : sequences_of(scene)) {
    if (images.size() < 2) continue;
    const double rounding = rounding_of_times(scene, images);
    for (std::size_t at = 0; at < images.size(); ++at) out[images[at]] = expect(scene, images, at, rounding);
  }
  return out;
}

std::size_t expect_motions(Reconstruction& scene) {
  const auto expected = expected_motions(scene);
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (expected[i] && !scene.images[i].motion) scene.images[i].motion = expected[i]->motion;
    count += scene.images[i].motion.has_value();
  }
  return count;
}

}  // namespace waymark::pipeline
