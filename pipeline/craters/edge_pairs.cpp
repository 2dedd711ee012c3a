// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/edge_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "pipeline/craters/pixel_noise.hpp"

namespace waymark::pipeline {
namespace {

using Vector = cv::Point2d;

constexpr double kAlongLight = 0.64;       // minimum |cosine| between the gradient of an edge and the light
constexpr std::size_t kMinEdgeLength = 6;  // minimum pixels of an edge, at its octave
constexpr double kMaxLengthRatio = 2.5;    // maximum, of the two edges of a crater
constexpr double kMaxDistance = 3.7;       // maximum, between their centres / the shorter edge
constexpr double kCone = 0.5;              // maximum offset across the light / distance along it
constexpr double kNeutralCost = 2.35;      // cost of a pair with probability 0.5, tuned on HRSC tile 1_24
constexpr double kMinAtOctave = 10, kMaxAtOctave = 64;  // pixels, diameters of one octave

// Arc of a rim.
struct Arc {
  std::vector<cv::Point> pixels;
  Vector middle, chord;
  double length = 0;    // of the chord
  double strength = 0;  // mean gradient
  bool opening = false;
};

// Connected edge pixels with the curvature of the sunward (`opening`) or the far rim.
std::vector<Arc> arcs_of(const cv::Mat1b& edges, const cv::Mat1f& along, const Vector& sun, bool opening) {
  cv::Mat1i labels;
  const int count = cv::connectedComponents(edges, labels, 8, CV_32S);
  std::vector<Arc> arcs(static_cast<std::size_t>(count));
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels(y, x) > 0) {
        Arc& arc = arcs[static_cast<std::size_t>(labels(y, x))];
        arc.pixels.emplace_back(x, y);
        arc.strength += std::abs(double(along(y, x)));
      }
  std::vector<Arc> good;
  for (Arc& arc : arcs) {
    if (arc.pixels.size() < kMinEdgeLength) continue;
    const Vector across{-sun.y, sun.x};
    const auto reach = [&](const cv::Point& p) { return Vector(p).dot(across); };
    const auto [low, high] = std::minmax_element(
        arc.pixels.begin(), arc.pixels.end(), [&](const cv::Point& a, const cv::Point& b) {
          return std::tuple(reach(a), a.y, a.x) < std::tuple(reach(b), b.y, b.x);
        });
    for (const cv::Point& p : arc.pixels) arc.middle += Vector(p);
    arc.middle *= 1.0 / double(arc.pixels.size());
    arc.chord = (Vector(*low) + Vector(*high)) / 2;
    arc.length = cv::norm(*high - *low) + 1;
    arc.strength /= double(arc.pixels.size());
    arc.opening = opening;
    // The sunward rim is convex towards the sun, the other away from it: the centre of an arc lies outside
    // its chord.
    const double bend = (arc.middle - arc.chord).dot(sun) * (opening ? 1 : -1);
    if (bend > -0.05 * arc.length) good.push_back(std::move(arc));
  }
  return good;
}

struct Pair {
  std::size_t opening, closing;
  double cost;
};

// Brightness must rise from the shaded to the lit wall: the last third of the line against the first.
bool brightens(const cv::Mat1f& image, const Vector& from, const Vector& to) {
  double first = 0, last = 0;
  for (int i = 1; i <= 8; ++i) {
    const Vector at = from + (to - from) * (i / 9.0);
    const int x = std::clamp(cvRound(at.x), 0, image.cols - 1),
              y = std::clamp(cvRound(at.y), 0, image.rows - 1);
    (i <= 4 ? first : last) += image(y, x);
  }
  return last > first;
}

std::vector<Pair> pairs_of(const std::vector<Arc>& arcs, const cv::Mat1f& image, const Vector& sun,
                           double contrast) {
  std::vector<Pair> pairs;
  const Vector across{-sun.y, sun.x};
  for (std::size_t i = 0; i < arcs.size(); ++i)
    for (std::size_t j = 0; arcs[i].opening && j < arcs.size(); ++j) {
      if (arcs[j].opening) continue;
      const Vector gap = arcs[i].middle - arcs[j].middle;  // towards the sun
      const double along = gap.dot(sun), off = std::abs(gap.dot(across));
      const double shorter = std::min(arcs[i].length, arcs[j].length),
                   longer = std::max(arcs[i].length, arcs[j].length);
      if (along < 0.5 * kMinAtOctave || along > 1.2 * kMaxAtOctave) continue;
      if (longer > kMaxLengthRatio * shorter || along > kMaxDistance * shorter || off > kCone * along)
        continue;
      if (!brightens(image, arcs[i].middle, arcs[j].middle)) continue;
      const double strength = std::min(arcs[i].strength, arcs[j].strength) / contrast;
      pairs.push_back({i, j,
                       longer / shorter - 1 + 1 / std::max(0.05, strength) + std::abs(along / shorter - 1.2) +
                           off / along});
    }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.opening, a.closing) < std::tie(b.cost, b.opening, b.closing);
  });
  return pairs;
}

VerifiedBowl fit_bowl(const Arc& opening, const Arc& closing, double cost, double shrink_x, double shrink_y) {
  std::vector<cv::Point> all = opening.pixels;
  all.insert(all.end(), closing.pixels.begin(), closing.pixels.end());
  const Vector middle = (opening.middle + closing.middle) / 2;
  const double apart = cv::norm(opening.middle - closing.middle);
  double width = apart * 1.05, height = width, angle = 0;
  Vector centre = middle;
  if (all.size() >= 8) {
    const cv::RotatedRect e = cv::fitEllipseDirect(all);
    const bool sound = e.size.width > 0.6 * apart && e.size.height > 0.6 * apart &&
                       e.size.width < 1.8 * apart && e.size.height < 1.8 * apart &&
                       cv::norm(Vector(e.center) - middle) < 0.3 * apart;
    if (sound)
      centre = e.center, width = e.size.width, height = e.size.height, angle = e.angle * kRadiansPerDegree;
  }
  const double shrink = std::sqrt(shrink_x * shrink_y);
  VerifiedBowl bowl;
  bowl.outline = {
      .x = (centre.x + 0.5) * shrink_x - 0.5,
      .y = (centre.y + 0.5) * shrink_y - 0.5,
      .major = std::max(width, height) * shrink,
      .minor = std::min(width, height) * shrink,
      .angle = std::remainder(width >= height ? angle : angle + std::numbers::pi / 2, std::numbers::pi)};
  if (bowl.outline.angle <= -std::numbers::pi / 2) bowl.outline.angle += std::numbers::pi;
  bowl.circle = {bowl.outline.x, bowl.outline.y, bowl.outline.diameter(),
                 1 / (1 + std::exp(cost - kNeutralCost))};
  bowl.centre_sd = 0.06 * bowl.circle.diameter + 0.3 * shrink;
  bowl.diameter_sd = 0.1 * bowl.circle.diameter + 0.5 * shrink;
  return bowl;
}

void search_octave(const cv::Mat1f& image, const Vector& sun, double shrink_x, double shrink_y,
                   std::vector<VerifiedBowl>& found) {
  cv::Mat1f smooth, gx, gy, along, strength;
  cv::GaussianBlur(image, smooth, {}, 1.2);
  cv::Sobel(smooth, gx, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(smooth, gy, CV_32F, 0, 1, 3, 0.125);
  along = gx * sun.x + gy * sun.y;
  cv::magnitude(gx, gy, strength);
  cv::Scalar mean, sd;
  cv::meanStdDev(strength, mean, sd);
  const double min_strength = mean[0] + 0.3 * sd[0], contrast = mean[0] + sd[0];
  // Non-maximum suppression along the gradient, rounded to eight directions.
  cv::Mat1b edges(image.size(), static_cast<unsigned char>(0));
  for (int y = 1; y + 1 < image.rows; ++y)
    for (int x = 1; x + 1 < image.cols; ++x) {
      const float s = strength(y, x);
      if (!(s > min_strength) || along(y, x) < kAlongLight * s) continue;
      const int dx = cvRound(gx(y, x) / s), dy = cvRound(gy(y, x) / s);
      if (s < strength(y + dy, x + dx) || s <= strength(y - dy, x - dx)) continue;
      edges(y, x) = 255;
    }
  // On both rims brightness increases towards the sun: from the shaded wall to the plain, and from the plain
  // to the lit wall. The curvature of an arc separates them; a straight arc may be either.
  std::vector<Arc> arcs = arcs_of(edges, along, sun, true);
  for (Arc& arc : arcs_of(edges, along, sun, false)) arcs.push_back(std::move(arc));
  std::vector<bool> used(arcs.size(), false);
  for (const Pair& pair : pairs_of(arcs, image, sun, contrast)) {
    if (used[pair.opening] || used[pair.closing]) continue;
    used[pair.opening] = used[pair.closing] = true;
    found.push_back(fit_bowl(arcs[pair.opening], arcs[pair.closing], pair.cost, shrink_x, shrink_y));
  }
}

}  // namespace

std::vector<VerifiedBowl> find_craters_by_edges(const FilledImage& image, Radians sun_angle,
                                                double min_diameter, double max_diameter) {
  const Vector sun{std::cos(sun_angle.value), std::sin(sun_angle.value)};
  const cv::Mat1f whole(static_cast<int>(image.pixels.rows()), static_cast<int>(image.pixels.columns()),
                        const_cast<float*>(image.pixels.cells().data()));
  std::vector<VerifiedBowl> found;
  cv::Mat1f octave = whole;
  for (double shrink = 1; std::min(octave.cols, octave.rows) >= 32 && kMinAtOctave * shrink <= max_diameter;
       shrink *= 2) {
    if (kMaxAtOctave * shrink >= min_diameter)
      search_octave(octave, sun, double(whole.cols) / octave.cols, double(whole.rows) / octave.rows, found);
    cv::Mat1f half;
    cv::resize(octave, half, {(octave.cols + 1) / 2, (octave.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
    octave = half;
  }
  return found;
}

}  // namespace waymark::pipeline
