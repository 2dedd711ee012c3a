// SPDX-License-Identifier: Apache-2.0
// A landmark type and its detector in laser scans: waymark --plugin posts.so map LOG --scans posts -o
// MAP.gpkg
#include <algorithm>
#include <cmath>
#include <vector>
#include <waymark/plug_in.hpp>
using namespace waymark;
using namespace waymark::localization;

namespace {

constexpr double kJump = 0.3;   // m between neighbouring beams that separates two objects
constexpr double kClear = 1;    // m by which what is beside a post is farther away
constexpr double kNoise = 0.1;  // m, of the differences of ranges on one post
constexpr double kMinWidth = 0.03, kMaxWidth = 0.6;  // m
constexpr double kMaxRange = 20;                     // m: farther posts have too few beams
constexpr std::size_t kMinBeams = 2;

LandmarkType post_type() {
  return {.name = "post",
          .summary = "Thin thing that stands alone: lamp, bollard, post of a sign, trunk",
          .features = {{"width", "m", Scale::ratio, kMinWidth, kMaxWidth, "Across the beams"}},
          .evidence = EvidenceModel::upright,
          .body = {"width", 0.5},
          .drawn_as = Solid::cylinder,
          .colour = "#7030a0",
          .size_feature = "width"};
}

/// A post in the frame of the sensor.
struct Post {
  double range = 0, bearing = 0;  // of its centre: m, and rad to the left
  double width = 0, width_sd = 0;
};

/// Returns the ranges, ten times the largest where there is no return. A beam that is lost on an object,
/// between two that hit it, takes their mean: else it would split the object into posts.
std::vector<double> ranges_of(const LaserScan& scan) {
  std::vector<double> ranges;
  for (const double range : scan.ranges)
    ranges.push_back(range > 0 && range < scan.max_range ? range : 10 * scan.max_range);
  for (std::size_t i = 1; i + 1 < ranges.size(); ++i)
    if (ranges[i] >= scan.max_range && std::abs(ranges[i - 1] - ranges[i + 1]) < kJump)
      ranges[i] = (ranges[i - 1] + ranges[i + 1]) / 2;
  return ranges;
}

/// Finds runs of beams that are nearer than what is beside them, and as wide and as deep as the front of a
/// cylinder.
std::vector<Post> find_posts(const LaserScan& scan) {
  std::vector<Post> posts;
  const std::vector<double> ranges = ranges_of(scan);
  const double step = std::abs(scan.angle_step);
  for (std::size_t first = 1; first + 1 < ranges.size();) {
    double sum = 0, nearest = ranges[first], farthest = nearest;
    std::size_t end = first;  // beyond the last beam of the run
    do {
      sum += ranges[end];
      nearest = std::min(nearest, ranges[end]);
      farthest = std::max(farthest, ranges[end]);
      ++end;
    } while (end < ranges.size() && std::abs(ranges[end] - ranges[end - 1]) < kJump);
    const auto beams = static_cast<double>(end - first);
    const double front = sum / beams, width = front * beams * step;
    const bool is_free =
        end < ranges.size() && ranges[first - 1] > front + kClear && ranges[end] > front + kClear;
    const bool is_post = width > kMinWidth && width < kMaxWidth && farthest - nearest < width / 2 + kNoise;
    if (is_free && is_post && end - first >= kMinBeams && front < kMaxRange)
      posts.push_back(
          {.range = front + 0.4 * width,  // beams hit the front, 0.1 of the width deep on average
           .bearing = scan.first_angle + scan.angle_step * (static_cast<double>(first + end - 1) / 2),
           .width = width,
           .width_sd = front * step});
    first = end;
  }
  return posts;
}

/// Returns the detector for the types of a map.
LaserDetector make_detector(const TypeRegistry& types) {
  const std::optional<TypeId> type = type_in_map(types, "post");
  const std::size_t width = type ? feature_index(types[*type], "width") : 0;
  return [type, width](const LaserScan& scan) {
    SightingSet set{scan.robot_from_sensor, {}};
    for (const Post& post : find_posts(scan)) {
      SeenLandmark seen;
      seen.type = type;
      seen.range = post.range;
      seen.range_sd = 0.05;
      seen.bearing = post.bearing;
      seen.bearing_sd = std::abs(scan.angle_step);
      seen.confidence = 0.7;
      if (type) {
        seen.features.value[width] = post.width;
        seen.features.variance[width] = post.width_sd * post.width_sd;
      }
      set.sightings.push_back(seen);
    }
    return set;
  };
}

}  // namespace

void waymark_plug_in(workflows::PlugIn& to) {
  to.types.add(post_type());
  to.scan_detectors.add({.name = "posts",
                         .summary = "Thin things that stand alone",
                         .record = "laser",
                         .types = {"post"},
                         .make = make_detector});
}
