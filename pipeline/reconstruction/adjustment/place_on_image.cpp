// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/place_on_image.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace waymark::pipeline {
namespace {

constexpr int kSearchCells = 48, kFineCells = 160;  // across the mosaic
constexpr double kYawTurn = 6 * std::numbers::pi / 180, kScaleRatio = 1.08;
constexpr double kMinCoverage = 0.6;  // of the mosaic, by the map
constexpr double kFewMapCells = 24;   // of the map, across the mosaic: less shows no pattern
constexpr std::size_t kPeaks = 4;     // kept per yaw and scale
constexpr std::size_t kRefined = 8;

/// Brightness about its local mean in units of its local contrast, and where it is known (1 or 0).
struct Texture {
  cv::Mat value, known;
};

struct Trial {
  double scale = 0, yaw = 0, x = 0, y = 0;  // metres per unit of the mosaic; of its middle, in the map
  double score = 0;
};

cv::Mat known_of(const cv::Mat& image) {
  cv::Mat known;
  cv::Mat(image == image).convertTo(known, CV_32F, 1.0 / 255);  // NaN differs from itself
  return known;
}

cv::Mat brightness_matrix(const Grid<float>& grid) {
  const auto cells = grid.cells();
  return cv::Mat(static_cast<int>(grid.rows()), static_cast<int>(grid.columns()), CV_32F,
                 const_cast<float*>(cells.data()))
      .clone();
}

cv::Mat blurred(const cv::Mat& image, double sigma) {
  cv::Mat out;
  cv::GaussianBlur(image, out, {}, sigma, sigma, cv::BORDER_CONSTANT);
  return out;
}

Texture texture_of(const cv::Mat& brightness, double sigma) {
  Texture out{.value = brightness.clone(), .known = known_of(brightness)};
  out.value.setTo(0, out.known == 0);
  const cv::Mat weight = blurred(out.known, sigma) + 1e-6;
  const cv::Mat difference = (out.value - blurred(out.value, sigma) / weight).mul(out.known);
  const cv::Mat variance = blurred(difference.mul(difference), sigma) / weight;
  const double usual = cv::sum(variance.mul(out.known))[0] / std::max(1.0, cv::sum(out.known)[0]);
  cv::Mat contrast;
  cv::sqrt(variance + 0.05 * usual + 1e-12, contrast);
  out.value = (difference / contrast).mul(out.known);
  out.value = cv::max(cv::min(out.value, 3.0), -3.0);
  return out;
}

// Means of the known brightness over cells of another size; NaN where less than half of a cell is known.
cv::Mat with_cells(const cv::Mat& brightness, int columns, int rows) {
  const cv::Mat known = known_of(brightness);
  cv::Mat value = brightness.clone(), sums, weights;
  value.setTo(0, known == 0);
  const int how = columns < brightness.cols ? cv::INTER_AREA : cv::INTER_LINEAR;
  cv::resize(value, sums, {columns, rows}, 0, 0, how);
  cv::resize(known, weights, {columns, rows}, 0, 0, how);
  cv::Mat out = sums / (weights + 1e-6);
  out.setTo(std::numeric_limits<float>::quiet_NaN(), weights < 0.5);
  return out;
}

Texture turned(const Texture& mosaic, double yaw) {
  const cv::Point2f middle(static_cast<float>(mosaic.value.cols - 1) / 2,
                           static_cast<float>(mosaic.value.rows - 1) / 2);
  const cv::Mat turn = cv::getRotationMatrix2D(middle, yaw * 180 / std::numbers::pi, 1);
  Texture out;
  cv::warpAffine(mosaic.value, out.value, turn, mosaic.value.size(), cv::INTER_LINEAR);
  cv::warpAffine(mosaic.known, out.known, turn, mosaic.known.size(), cv::INTER_LINEAR);
  out.known.setTo(0, out.known < 0.99);
  out.known.setTo(1, out.known > 0);
  out.value = out.value.mul(out.known);
  return out;
}

// Transform of a matrix at the upper left of zeros.
cv::Mat spectrum_of(const cv::Mat& matrix, cv::Size size) {
  cv::Mat out = cv::Mat::zeros(size, CV_32F);
  matrix.copyTo(out(cv::Rect({0, 0}, matrix.size())));
  cv::dft(out, out, 0, matrix.rows);
  return out;
}

/// Transforms of a part of the map, from which its correlation with any mosaic follows.
struct MapSpectra {
  cv::Size map = {}, size = {};
  cv::Mat value, squares, known;

  explicit MapSpectra(const Texture& texture)
      : map(texture.value.size()),
        size(cv::getOptimalDFTSize(map.width), cv::getOptimalDFTSize(map.height)),
        value(spectrum_of(texture.value, size)),
        squares(spectrum_of(texture.value.mul(texture.value), size)),
        known(spectrum_of(texture.known, size)) {}
};

// Sums of products of a map and a pattern at each shift of the pattern's upper left corner.
cv::Mat correlated(const cv::Mat& map, const cv::Mat& pattern, cv::Size shifts) {
  cv::Mat out;
  cv::mulSpectrums(map, pattern, out, 0, true);
  cv::dft(out, out, cv::DFT_INVERSE | cv::DFT_SCALE, shifts.height);
  return out(cv::Rect({0, 0}, shifts));
}

// Normalized cross-correlation of a mosaic with the map at each shift of its upper left corner; -1 where the
// map covers too little of it.
cv::Mat scores_of(const MapSpectra& map, const Texture& mosaic) {
  const double count = cv::sum(mosaic.known)[0];
  if (!(count > 0)) return {};
  const cv::Mat pattern = (mosaic.value - cv::sum(mosaic.value)[0] / count).mul(mosaic.known);
  const double energy = pattern.dot(pattern);
  const cv::Mat pattern_there = spectrum_of(pattern, map.size),
                known_there = spectrum_of(mosaic.known, map.size);
  const cv::Size shifts(map.map.width - pattern.cols + 1, map.map.height - pattern.rows + 1);
  const cv::Mat covered = cv::max(correlated(map.known, known_there, shifts), 1e-3);
  const cv::Mat sums = correlated(map.value, known_there, shifts);
  cv::Mat squares = correlated(map.squares, known_there, shifts) - sums.mul(sums) / covered;
  squares = cv::max(squares, 0.01 * count);
  cv::Mat norm;
  cv::sqrt(squares.mul(covered) * (energy / count), norm);
  cv::Mat out = correlated(map.value, pattern_there, shifts) / norm;
  out.setTo(-1, covered < kMinCoverage * count);
  return out;
}

/// Mosaic and map at the cells of one scale; the map has a border of half a mosaic.
class Correlator {
 public:
  Correlator(const LevelImage& mosaic, const LevelImage& map)
      : mosaic_(brightness_matrix(mosaic.brightness)),
        map_(brightness_matrix(map.brightness)),
        of_map_(map.grid) {
    extent_ = mosaic.grid.cell * double(std::max(mosaic.grid.columns, mosaic.grid.rows));
    const int side = std::max(mosaic_.cols, mosaic_.rows);
    square_ = cv::Mat(side, side, CV_32F, std::numeric_limits<float>::quiet_NaN());
    mosaic_.copyTo(
        square_(cv::Rect((side - mosaic_.cols) / 2, (side - mosaic_.rows) / 2, mosaic_.cols, mosaic_.rows)));
    search_ = texture_of(with_cells(square_, kSearchCells, kSearchCells), kSearchCells / 10.0);
    fine_ = texture_of(with_cells(square_, kFineCells, kFineCells), kFineCells / 10.0);
  }

  double extent() const { return extent_; }

  // The best trials of one scale, over all yaws and shifts.
  std::vector<Trial> search(double scale) const {
    const double cell = scale * extent_ / kSearchCells;
    const MapSpectra map(map_texture(map_, cell, kSearchCells, kSearchCells / 2));
    std::vector<Trial> out;
    const int yaws = static_cast<int>(std::lround(2 * std::numbers::pi / kYawTurn));
    for (int i = 0; i < yaws; ++i) {
      cv::Mat scores = scores_of(map, turned(search_, i * kYawTurn));
      for (std::size_t peak = 0; peak < kPeaks && !scores.empty(); ++peak) {
        double best = 0;
        cv::Point at;
        cv::minMaxLoc(scores, nullptr, &best, nullptr, &at);
        if (!(best > 0)) break;
        out.push_back({.scale = scale,
                       .yaw = i * kYawTurn,
                       .x = of_map_.west + at.x * cell,
                       .y = of_map_.north - at.y * cell,
                       .score = best});
        cv::circle(scores, at, kSearchCells / 8, -1, cv::FILLED);
      }
    }
    return out;
  }

  // The best trial of one scale and some yaws, within some cells of a start.
  Trial near(const Trial& start, double scale, const std::vector<double>& yaws, int reach) const {
    const double cell = scale * extent_ / kFineCells;
    const double half = (kFineCells / 2 + reach + 1) * cell;
    const SurfaceGrid& g = of_map_;
    const auto column_at = [&](double x) {
      return static_cast<int>(std::clamp(std::floor((x - g.west) / g.cell), 0.0, double(map_.cols)));
    };
    const auto row_at = [&](double y) {
      return static_cast<int>(std::clamp(std::floor((g.north - y) / g.cell), 0.0, double(map_.rows)));
    };
    const cv::Rect part(cv::Point(column_at(start.x - half), row_at(start.y + half)),
                        cv::Point(column_at(start.x + half + g.cell), row_at(start.y - half - g.cell)));
    Trial best = start;
    best.score = -1;
    if (part.width < 8 || part.height < 8) return best;
    const double west = g.west + part.x * g.cell, north = g.north - part.y * g.cell;
    const Texture map = map_texture(map_(part), cell, kFineCells, kFineCells / 2);
    const int c = static_cast<int>(std::lround((start.x - west) / cell)),
              r = static_cast<int>(std::lround((north - start.y) / cell));
    const int side = kFineCells + 2 * reach;
    const cv::Rect window =
        cv::Rect(c - reach, r - reach, side, side) & cv::Rect(0, 0, map.value.cols, map.value.rows);
    if (window.width < kFineCells || window.height < kFineCells) return best;
    const MapSpectra there({.value = map.value(window), .known = map.known(window)});
    for (const double yaw : yaws) {
      const cv::Mat scores = scores_of(there, turned(fine_, yaw));
      if (scores.empty()) continue;
      double score = 0;
      cv::Point at;
      cv::minMaxLoc(scores, nullptr, &score, nullptr, &at);
      if (score > best.score)
        best = {.scale = scale,
                .yaw = yaw,
                .x = west + (window.x + at.x) * cell,
                .y = north - (window.y + at.y) * cell,
                .score = score};
    }
    return best;
  }

 private:
  // With a border of `border` cells, the corner of the mosaic at (0, 0) has its middle at the map's corner.
  Texture map_texture(const cv::Mat& map, double cell, int across, int border) const {
    const double ratio = of_map_.cell / cell;
    const int columns = std::max(1, static_cast<int>(std::lround(map.cols * ratio))),
              rows = std::max(1, static_cast<int>(std::lround(map.rows * ratio)));
    Texture out = texture_of(with_cells(map, columns, rows), across / 10.0);
    cv::copyMakeBorder(out.value, out.value, border, border, border, border, cv::BORDER_CONSTANT, 0);
    cv::copyMakeBorder(out.known, out.known, border, border, border, border, cv::BORDER_CONSTANT, 0);
    return out;
  }

  cv::Mat mosaic_, map_, square_;
  SurfaceGrid of_map_;
  double extent_ = 0;
  Texture search_, fine_;
};

constexpr double kSimilarScale = 0.1, kSameScale = 0.4;  // logarithms of ratios

// Whether trials differ by an eighth of the mosaic, 10 degrees or a ratio of scales.
bool apart_in_image(const Trial& a, const Trial& b, double extent, double scales) {
  const double turn = std::abs(std::remainder(a.yaw - b.yaw, 2 * std::numbers::pi));
  return std::hypot(a.x - b.x, a.y - b.y) > std::min(a.scale, b.scale) * extent / 8 ||
         std::abs(std::log(a.scale / b.scale)) > scales || turn > 10 * std::numbers::pi / 180;
}

std::vector<Trial> distinct(std::vector<Trial> trials, double extent, double scales, std::size_t count) {
  std::ranges::stable_sort(trials, std::greater{}, &Trial::score);
  std::vector<Trial> out;
  for (const Trial& trial : trials) {
    if (out.size() == count) break;
    if (std::ranges::all_of(out,
                            [&](const Trial& kept) { return apart_in_image(kept, trial, extent, scales); }))
      out.push_back(trial);
  }
  return out;
}

Trial refined_placement(const Correlator& correlator, const Trial& start) {
  struct Round {
    double scale, yaw;  // step
    int reach;          // cells
  };
  constexpr double kDegree = std::numbers::pi / 180;
  Trial best = start;
  best.score = -1;
  for (const Round& round :
       {Round{0.03, 2.5 * kDegree, 12}, Round{0.012, kDegree, 5}, Round{0.004, 0.35 * kDegree, 3}}) {
    const Trial middle = best.score > 0 ? best : start;
    std::vector<double> yaws;
    for (int i = -2; i <= 2; ++i) yaws.push_back(middle.yaw + i * round.yaw);
    for (int i = -2; i <= 2; ++i) {
      const Trial trial = correlator.near(middle, middle.scale * (1 + i * round.scale), yaws, round.reach);
      if (trial.score > best.score) best = trial;
    }
  }
  return best;
}

}  // namespace

ImagePlacementResult place_on_image(const LevelImage& mosaic, const LevelImage& map,
                                    const ImagePlacementRules& rules) {
  const Correlator correlator(mosaic, map);
  const double side = double(std::max(map.grid.columns, map.grid.rows)) * map.grid.cell;
  const double largest = rules.largest * side / correlator.extent();
  const double smallest = std::max(rules.smallest * side, kFewMapCells * map.grid.cell) / correlator.extent();
  std::vector<double> scales;
  for (double scale = largest; scale >= smallest; scale /= kScaleRatio) scales.push_back(scale);
  std::vector<std::vector<Trial>> by_scale(scales.size());
  tbb::parallel_for(
      std::size_t{0}, scales.size(), [&](std::size_t i) { by_scale[i] = correlator.search(scales[i]); },
      tbb::simple_partitioner());
  std::vector<Trial> trials;
  for (const auto& some : by_scale) trials.insert(trials.end(), some.begin(), some.end());
  std::vector<Trial> best = distinct(std::move(trials), correlator.extent(), kSimilarScale, kRefined);
  tbb::parallel_for(
      std::size_t{0}, best.size(), [&](std::size_t i) { best[i] = refined_placement(correlator, best[i]); },
      tbb::simple_partitioner());
  best = distinct(std::move(best), correlator.extent(), kSameScale, 2);
  if (best.empty() || !(best[0].score > 0))
    return {.message = "the map image has no pattern that the images could be compared with"};
  ImagePlacement placed{.score = best[0].score,
                        .next_best_score = best.size() > 1 ? std::max(0.0, best[1].score) : 0};
  if (!(placed.score >= rules.min_score))
    return {.message =
                fmt::format("the images are not found in the map image: at the best place the correlation "
                            "is {:.2f}, and {:.2f} is needed",
                            placed.score, rules.min_score)};
  if (!(placed.score >= rules.min_distinction * placed.next_best_score))
    return {.message = fmt::format(
                "the place in the map image is ambiguous: two places correlate by {:.2f} and {:.2f}",
                placed.score, placed.next_best_score)};
  Similarity& to = placed.map_from_mosaic;
  to.scale = best[0].scale;
  to.rotation = Eigen::AngleAxisd(best[0].yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const SurfaceGrid& g = mosaic.grid;
  const Eigen::Vector3d middle(g.west + g.cell * double(g.columns) / 2, g.north - g.cell * double(g.rows) / 2,
                               0);
  to.shift = Eigen::Vector3d(best[0].x, best[0].y, 0) - to.scale * (to.rotation * middle);
  return {.found = placed};
}

}  // namespace waymark::pipeline
