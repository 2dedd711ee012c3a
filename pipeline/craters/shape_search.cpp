// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/shape_search.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/pixel_noise.hpp"

namespace waymark {
namespace {

constexpr int kSizesPerOctave = 7;
constexpr int kTile = 256;           // side of a transform
constexpr double kLargestBowl = 24;  // pixels at the level it is sought on

// One size of bowl: the spectra of its templates, ready to multiply.
struct Bowl {
  double diameter = 0;  // pixels of the level
  int half = 0;         // of the template's side
  std::vector<cv::Mat1f> spectra;
};

cv::Mat1f as_matrix(const Pixels& pixels) {
  return {static_cast<int>(pixels.rows()), static_cast<int>(pixels.columns()),
          const_cast<float*>(pixels.cells().data())};
}

Bowl make_bowl(double diameter, const std::vector<Pixels>& shapes) {
  Bowl bowl{.diameter = diameter, .half = 0, .spectra = {}};
  for (const Pixels& shape : shapes) {
    bowl.half = static_cast<int>(shape.columns() / 2);
    cv::Mat1f padded(kTile, kTile, 0.0F), spectrum;
    as_matrix(shape).copyTo(padded(cv::Rect(0, 0, 2 * bowl.half + 1, 2 * bowl.half + 1)));
    cv::dft(padded, spectrum, 0, 2 * bowl.half + 1);
    bowl.spectra.push_back(spectrum);
  }
  return bowl;
}

// Local sums of the tile and its square.
struct Sums {
  cv::Mat1d sum, squares;
  explicit Sums(const cv::Mat1f& tile) { cv::integral(tile, sum, squares, CV_64F, CV_64F); }
  // n times the variance over squares of `half` about `count` cells of a row, from (column, row) on.
  void spreads(int column, int row, int half, int count, double* out) const {
    const int side = 2 * half + 1;
    const double each = 1.0 / (double(side) * side);
    const double *top = sum.ptr<double>(row - half) + column - half,
                 *low = sum.ptr<double>(row - half + side) + column - half;
    const double *top2 = squares.ptr<double>(row - half) + column - half,
                 *low2 = squares.ptr<double>(row - half + side) + column - half;
    for (int i = 0; i < count; ++i) {
      const double total = low[i + side] - top[i + side] - low[i] + top[i];
      const double total2 = low2[i + side] - top2[i + side] - low2[i] + top2[i];
      out[i] = std::max(0.0, total2 - total * total * each);
    }
  }
};

// Correlation in [-1, 1] at the pixels of `tile` that are `margin` from its edge.
cv::Mat1f correlation(const cv::Mat1f& spectrum, const Sums& sums, const Bowl& bowl, int margin,
                      double noise) {
  const int inner = kTile - 2 * margin;
  cv::Mat1f best(inner, inner, -1.0F), product, response;
  const cv::Rect valid(margin - bowl.half, margin - bowl.half, inner, inner);
  for (const cv::Mat1f& shape : bowl.spectra) {
    cv::mulSpectrums(spectrum, shape, product, 0, true);
    cv::dft(product, response, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT, valid.y + valid.height);
    cv::max(cv::InputArray(best), cv::InputArray(response(valid)), cv::OutputArray(best));
  }
  const double cells = (2.0 * bowl.half + 1) * (2.0 * bowl.half + 1);
  std::vector<double> spread(static_cast<std::size_t>(inner));
  const double floor = cells * noise * noise + 1e-30;
  for (int y = 0; y < inner; ++y) {
    sums.spreads(margin, y + margin, bowl.half, inner, spread.data());
    float* row = best.ptr<float>(y);
    for (int x = 0; x < inner; ++x)
      row[x] /= static_cast<float>(std::sqrt(spread[static_cast<std::size_t>(x)] + floor));
  }
  return best;
}

// Offset of the vertex of the parabola through three equidistant values, the middle the highest.
double vertex(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

// Local maxima whose own pixel lies in `core`; level and tile coordinates to those of the image by
// `to_image`.
template <class ToImage>
void collect(const cv::Mat1f& score, const cv::Rect& core, double least, const ToImage& to_image,
             std::vector<CraterCandidate>& found) {
  for (int y = core.y; y < core.y + core.height; ++y) {
    const float* row = score.ptr<float>(y);
    for (int x = core.x; x < core.x + core.width; ++x) {
      const float s = row[x];
      if (!(s >= least) || s < row[x - 1]) continue;
      bool highest = true;
      for (int j = -1; j <= 1 && highest; ++j)
        for (int i = -1; i <= 1 && highest; ++i)
          if (i != 0 || j != 0)
            highest = j < 0 || (j == 0 && i < 0) ? s > score(y + j, x + i) : s >= score(y + j, x + i);
      if (!highest) continue;
      found.push_back(to_image(x + vertex(score(y, x - 1), s, score(y, x + 1)),
                               y + vertex(score(y - 1, x), s, score(y + 1, x)), static_cast<double>(s)));
    }
  }
}

// `made`: by size, once for all levels; what is not there yet is added.
std::vector<Bowl> bowls_of_level(int level, const ShapeSearch& search, std::map<int, Bowl>& made) {
  std::vector<Bowl> bowls;
  const double shrink = std::exp2(level);
  // The finest level also has the bowls too small for an octave of their own.
  for (int i = level == 0 ? -kSizesPerOctave : 0; i < kSizesPerOctave; ++i) {
    const double diameter = kLargestBowl / 2 * std::exp2(static_cast<double>(i) / kSizesPerOctave);
    if (diameter * shrink < search.min_diameter * 0.95 || diameter * shrink > search.max_diameter * 1.05)
      continue;
    auto known = made.find(i);
    if (known == made.end()) known = made.emplace(i, make_bowl(diameter, search.shapes(diameter))).first;
    bowls.push_back(known->second);
  }
  return bowls;
}

void search_level(const cv::Mat1f& image, double shrink_x, double shrink_y, const std::vector<Bowl>& bowls,
                  double least, std::vector<CraterCandidate>& candidates) {
  int widest = 0;
  for (const Bowl& bowl : bowls) widest = std::max(widest, bowl.half);
  const int margin = widest + 1, core = kTile - 2 * margin - 2;
  const double noise = pixel_noise(image.ptr<float>(), image.cols, image.rows);
  cv::Mat1f padded;
  const int columns = (image.cols + core - 1) / core, rows = (image.rows + core - 1) / core;
  const int lead = margin + 1;
  cv::copyMakeBorder(image, padded, lead, lead + rows * core - image.rows, lead,
                     lead + columns * core - image.cols, cv::BORDER_REFLECT_101);
  std::vector<std::vector<CraterCandidate>> found(static_cast<std::size_t>(columns) *
                                                  static_cast<std::size_t>(rows));
  tbb::parallel_for(0, columns * rows, [&](int tile_index) {
    const int x0 = tile_index % columns * core, y0 = tile_index / columns * core;
    cv::Mat1f tile = padded(cv::Rect(x0, y0, kTile, kTile)).clone();
    tile -= cv::mean(tile)[0];
    const Sums sums(tile);
    cv::Mat1f spectrum;
    cv::dft(tile, spectrum);
    const cv::Rect inside(1, 1, std::min(core, image.cols - x0), std::min(core, image.rows - y0));
    for (const Bowl& bowl : bowls) {
      const cv::Mat1f score = correlation(spectrum, sums, bowl, margin, noise);
      const auto to_image = [&](double x, double y, double s) {
        return CraterCandidate{(x - 1 + x0 + 0.5) * shrink_x - 0.5, (y - 1 + y0 + 0.5) * shrink_y - 0.5,
                               bowl.diameter * std::sqrt(shrink_x * shrink_y), s};
      };
      collect(score, inside, least, to_image, found[static_cast<std::size_t>(tile_index)]);
    }
  });
  for (const auto& part : found) candidates.insert(candidates.end(), part.begin(), part.end());
}

}  // namespace

std::vector<CraterCandidate> shape_candidates(const Pixels& image, const ShapeSearch& search) {
  std::vector<CraterCandidate> candidates;
  std::map<int, Bowl> made;
  cv::Mat1f at_level = as_matrix(image);
  for (int level = 0;; ++level) {
    if (std::min(at_level.cols, at_level.rows) < 8 ||
        kLargestBowl / 2 * std::exp2(level) > search.max_diameter)
      break;
    const auto bowls = bowls_of_level(level, search, made);
    cv::Mat1f searched = at_level, mean;
    if (search.level_mean > 0) {
      cv::GaussianBlur(at_level, mean, {}, search.level_mean, 0, cv::BORDER_REFLECT_101);
      searched = at_level - mean;
    }
    if (!bowls.empty())
      search_level(searched, static_cast<double>(image.columns()) / at_level.cols,
                   static_cast<double>(image.rows()) / at_level.rows, bowls, search.min_correlation,
                   candidates);
    cv::Mat1f half;
    cv::resize(at_level, half, {(at_level.cols + 1) / 2, (at_level.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
    at_level = half;
  }
  return candidates;
}

}  // namespace waymark
