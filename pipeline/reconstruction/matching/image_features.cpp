// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/matching/image_features.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

namespace waymark::pipeline {
namespace {

constexpr double kShift = 0.25;    // of OpenCV 4.6 to the right and down, pixels
constexpr int kTile = 1536;        // side of a tile, pixels
constexpr int kMargin = 112;       // around a tile: the window of a descriptor reaches 10.6 scales
constexpr double kTileScale = 10;  // larger features of a tiled image come from the reduced image
constexpr int kReduction = 4;
constexpr double kWholePixels = 2.5e6;  // images up to this size are searched at once
constexpr double kContrast = 0.01;      // of DoG extrema, after the stretch

struct Candidate {
  Feature feature;
  float response = 0;
  int octave = 0;  // OpenCV's packed octave and layer
};

// Grey levels 0 to 255 between the 0.1 and 99.9 percentiles, and sums of unusable pixels.
struct Prepared {
  cv::Mat grey;
  cv::Mat missing, clipped;  // integrals of counts
};

struct GreyRange {
  float low = 0, high = 0;
  float middle = 0;
};

GreyRange range_of(const Pixels& image) {
  std::vector<float> values;
  const std::size_t step = std::max<std::size_t>(1, image.cells().size() / 1'000'000);
  for (std::size_t i = 0; i < image.cells().size(); i += step)
    if (std::isfinite(image.cells()[i])) values.push_back(image.cells()[i]);
  if (values.empty()) return {};
  const auto quantile = [&](double fraction) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  return {.low = quantile(0.001), .high = quantile(0.999), .middle = quantile(0.5)};
}

Prepared prepare(const Pixels& image, const GreyRange& range, double saturated) {
  const int rows = static_cast<int>(image.rows()), columns = static_cast<int>(image.columns());
  Prepared out{.grey = cv::Mat(rows, columns, CV_8U), .missing = {}, .clipped = {}};
  cv::Mat missing(rows, columns, CV_8U), clipped(rows, columns, CV_8U);
  const float gain = 255 / (range.high - range.low);
  for (int r = 0; r < rows; ++r) {
    const std::span<const float> from = image.row(r);
    for (int c = 0; c < columns; ++c) {
      const float value = from[static_cast<std::size_t>(c)];
      const bool absent = !std::isfinite(value);
      const bool clip = !absent && ((saturated > 0 && double(value) >= saturated) || value <= 0);
      missing.at<unsigned char>(r, c) = absent ? 1 : 0;
      clipped.at<unsigned char>(r, c) = clip ? 1 : 0;
      const float level = ((absent ? range.middle : value) - range.low) * gain;
      out.grey.at<unsigned char>(r, c) =
          static_cast<unsigned char>(std::lround(std::clamp(level, 0.0F, 255.0F)));
    }
  }
  cv::integral(missing, out.missing, CV_32S);
  cv::integral(clipped, out.clipped, CV_32S);
  return out;
}

double fraction_in(const cv::Mat& integral, const Eigen::Vector2d& about, double reach) {
  const auto clamp = [](double value, int limit) {
    return std::clamp(static_cast<int>(std::lround(value)), 0, limit);
  };
  const int left = clamp(about.x() - reach, integral.cols - 1),
            right = clamp(about.x() + reach + 1, integral.cols - 1);
  const int top = clamp(about.y() - reach, integral.rows - 1),
            bottom = clamp(about.y() + reach + 1, integral.rows - 1);
  const int area = (right - left) * (bottom - top);
  if (area <= 0) return 1;
  const int sum = integral.at<int>(bottom, right) - integral.at<int>(bottom, left) -
                  integral.at<int>(top, right) + integral.at<int>(top, left);
  return double(sum) / double(area);
}

bool is_usable(const Prepared& image, const Feature& feature) {
  return fraction_in(image.missing, feature.pixel, std::max(4.0, 5 * feature.scale)) == 0 &&
         fraction_in(image.clipped, feature.pixel, std::max(4.0, 3 * feature.scale)) <= 1.0 / 3;
}

// Total order: no two candidates of an image compare equal but duplicates.
auto rank_of(const Candidate& c) {
  return std::tuple(-c.response, c.feature.pixel.y(), c.feature.pixel.x(), c.feature.scale, c.feature.angle);
}

std::vector<Candidate> spread(std::vector<Candidate> all, std::size_t budget, double density) {
  if (all.size() <= budget) return all;
  std::ranges::sort(all, {}, rank_of);
  const double side = std::sqrt(8 / density);  // about eight features per cell
  std::vector<std::tuple<int, std::size_t>> order;
  std::vector<std::pair<std::pair<int, int>, int>> taken;
  std::vector<std::size_t> by_cell(all.size());
  std::iota(by_cell.begin(), by_cell.end(), std::size_t{0});
  const auto cell = [&](std::size_t i) {
    return std::pair(static_cast<int>(all[i].feature.pixel.y() / side),
                     static_cast<int>(all[i].feature.pixel.x() / side));
  };
  std::ranges::stable_sort(by_cell, {}, cell);
  for (std::size_t i = 0, first = 0; i < by_cell.size(); ++i) {
    if (cell(by_cell[i]) != cell(by_cell[first])) first = i;
    order.emplace_back(static_cast<int>(i - first), by_cell[i]);
  }
  std::ranges::sort(order);
  std::vector<Candidate> chosen;
  for (std::size_t i = 0; i < budget; ++i) chosen.push_back(all[std::get<1>(order[i])]);
  return chosen;
}

cv::KeyPoint key_point(const Candidate& c) {
  return {static_cast<float>(c.feature.pixel.x() + kShift),
          static_cast<float>(c.feature.pixel.y() + kShift),
          static_cast<float>(2 * c.feature.scale),
          static_cast<float>(c.feature.angle),
          c.response,
          c.octave};
}

Descriptor root_sift(const cv::Mat& row) {
  float sum = 0;
  for (int i = 0; i < row.cols; ++i) sum += row.at<float>(0, i);
  Descriptor out{};
  if (!(sum > 0)) return out;
  for (int i = 0; i < row.cols; ++i)
    out[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(std::lround(std::min(255.0F, 512 * std::sqrt(row.at<float>(0, i) / sum))));
  return out;
}

struct Described {
  Feature feature;
  Descriptor descriptor;
};

std::vector<Described> describe_spread(const Prepared& image, std::size_t budget, double density) {
  const cv::Ptr<cv::SIFT> sift = cv::SIFT::create(0, 3, kContrast, 10, 1.6);
  std::vector<cv::KeyPoint> found;
  sift->detect(image.grey, found);
  std::vector<Candidate> candidates;
  for (const cv::KeyPoint& k : found) {
    const Candidate c{.feature = {.pixel = {double(k.pt.x) - kShift, double(k.pt.y) - kShift},
                                  .scale = double(k.size) / 2,
                                  .angle = double(k.angle)},
                      .response = k.response,
                      .octave = k.octave};
    if (is_usable(image, c.feature)) candidates.push_back(c);
  }
  candidates = spread(std::move(candidates), budget, density);
  std::vector<cv::KeyPoint> points;
  for (const Candidate& c : candidates) points.push_back(key_point(c));
  std::vector<Described> out;
  if (points.empty()) return out;
  cv::Mat descriptors;
  sift->compute(image.grey, points, descriptors);
  for (std::size_t i = 0; i < points.size(); ++i)
    out.push_back({{.pixel = {double(points[i].pt.x) - kShift, double(points[i].pt.y) - kShift},
                    .scale = double(points[i].size) / 2,
                    .angle = double(points[i].angle)},
                   root_sift(descriptors.row(static_cast<int>(i)))});
  return out;
}

Pixels cut(const Pixels& image, const Window& window) {
  Pixels part(window.columns, window.rows);
  for (std::int64_t r = 0; r < window.rows; ++r)
    std::ranges::copy(
        image.row(window.row + r)
            .subspan(static_cast<std::size_t>(window.column), static_cast<std::size_t>(window.columns)),
        part.row(r).begin());
  return part;
}

// Mean of blocks; NaN where a pixel is missing.
Pixels reduce(const Pixels& image, int by) {
  Pixels small(image.columns() / by, image.rows() / by);
  for (std::int64_t r = 0; r < small.rows(); ++r)
    for (std::int64_t c = 0; c < small.columns(); ++c) {
      float sum = 0;
      for (int y = 0; y < by; ++y)
        for (int x = 0; x < by; ++x) sum += image(c * by + x, r * by + y);
      small(c, r) = sum / static_cast<float>(by * by);
    }
  return small;
}

std::size_t budget_of(std::int64_t pixels, double density) {
  return static_cast<std::size_t>(std::ceil(double(pixels) * density));
}

std::vector<Described> describe_tiles(const Pixels& image, const GreyRange& range,
                                      const FeatureSettings& settings) {
  std::vector<Described> all;
  for (std::int64_t top = 0; top < image.rows(); top += kTile)
    for (std::int64_t left = 0; left < image.columns(); left += kTile) {
      const Window core{left, top, std::min<std::int64_t>(kTile, image.columns() - left),
                        std::min<std::int64_t>(kTile, image.rows() - top)};
      Window wide{std::max<std::int64_t>(0, left - kMargin), std::max<std::int64_t>(0, top - kMargin), 0, 0};
      wide.columns = std::min(image.columns(), core.end_column() + kMargin) - wide.column;
      wide.rows = std::min(image.rows(), core.end_row() + kMargin) - wide.row;
      const Prepared part = prepare(cut(image, wide), range, settings.saturated);
      const Eigen::Vector2d corner(static_cast<double>(wide.column), static_cast<double>(wide.row));
      for (Described& one :
           describe_spread(part, budget_of(wide.cells(), settings.density), settings.density)) {
        one.feature.pixel += corner;
        const auto column = static_cast<std::int64_t>(std::floor(one.feature.pixel.x() + 0.5)),
                   row = static_cast<std::int64_t>(std::floor(one.feature.pixel.y() + 0.5));
        if (one.feature.scale <= kTileScale && core.contains(column, row)) all.push_back(std::move(one));
      }
    }
  return all;
}

}  // namespace

ImageFeatures find_features(const Pixels& image, const FeatureSettings& settings) {
  ImageFeatures out;
  if (image.columns() < 16 || image.rows() < 16) return out;
  const GreyRange range = range_of(image);
  if (!(range.high > range.low)) return out;
  std::vector<Described> all;
  if (double(image.cells().size()) <= kWholePixels) {
    all = describe_spread(prepare(image, range, settings.saturated),
                          budget_of(image.columns() * image.rows(), settings.density), settings.density);
  } else {
    all = describe_tiles(image, range, settings);
    FeatureSettings coarse = settings;
    coarse.density *= kReduction;  // a quarter of the features that the image may have
    const ImageFeatures large = find_features(reduce(image, kReduction), coarse);
    for (std::size_t i = 0; i < large.features.size(); ++i) {
      Feature f = large.features[i];
      f.pixel = kReduction * (f.pixel.array() + 0.5) - 0.5;
      f.scale *= kReduction;
      if (f.scale > kTileScale) all.push_back({f, large.descriptors[i]});
    }
  }
  std::ranges::sort(all, {}, [](const Described& d) {
    return std::tuple(-d.feature.scale, d.feature.pixel.y(), d.feature.pixel.x(), d.feature.angle);
  });
  for (Described& one : all) {
    out.features.push_back(one.feature);
    out.descriptors.push_back(one.descriptor);
  }
  return out;
}

}  // namespace waymark::pipeline
