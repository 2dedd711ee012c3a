// SPDX-License-Identifier: Apache-2.0
#include "pipeline/craters/shape_search.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "pipeline/craters/pixel_noise.hpp"
#include "pipeline/craters/tile_correlation.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kSizesPerOctave = 7;
constexpr double kMaxBowl = 24;  // pixels of its pyramid level

// Templates of one diameter, two in each spectrum (the second as imaginary part).
struct Bowl {
  double diameter = 0;  // pixels of the level
  int half = 0;         // of the template's side
  std::size_t shapes = 0;
  std::vector<ComplexTile> spectra;
};

cv::Mat1f as_matrix(const Pixels& pixels) {
  return {static_cast<int>(pixels.rows()), static_cast<int>(pixels.columns()),
          const_cast<float*>(pixels.cells().data())};
}

// Correlation is a product with the conjugate; the centre of the template is moved to the first cell of the
// tile.
Bowl make_bowl(double diameter, const std::vector<Pixels>& shapes) {
  Bowl bowl{.diameter = diameter, .half = 0, .shapes = shapes.size(), .spectra = {}};
  for (std::size_t i = 0; i < shapes.size(); i += 2) {
    bowl.half = static_cast<int>(shapes[i].columns() / 2);
    ComplexTile tile;
    const auto put = [&](const Pixels& shape, std::vector<float>& part, float scale) {
      for (int y = -bowl.half; y <= bowl.half; ++y)
        for (int x = -bowl.half; x <= bowl.half; ++x)
          part[static_cast<std::size_t>((y & (kTileSide - 1)) * kTileSide + (x & (kTileSide - 1)))] =
              scale * shape(x + bowl.half, y + bowl.half);
    };
    constexpr float each = 1.0F / ComplexTile::kCells;
    put(shapes[i], tile.real, each);
    if (i + 1 < shapes.size()) put(shapes[i + 1], tile.imaginary, -each);
    forward_transform(tile);
    for (float& value : tile.imaginary) value = -value;
    bowl.spectra.push_back(std::move(tile));
  }
  return bowl;
}

// Stores the squares of the correlation, with their sign, in the real part of `best`, for pixels at least
// `margin` from the edge of the tile.
void correlate(const ComplexTile& spectrum, const TileSums& sums, const Bowl& bowl, int margin, double noise,
               ComplexTile& best, ComplexTile& other) {
  // The last template may be unpaired.
  const auto paired = [&](std::size_t i) { return 2 * i + 1 < bowl.shapes; };
  inverse_transform_product(spectrum, bowl.spectra[0], best);
  for (std::size_t i = 1; i < bowl.spectra.size(); ++i) {
    inverse_transform_product(spectrum, bowl.spectra[i], other);
    take_maximum(best.real, other.real);
    if (paired(i)) take_maximum(best.real, other.imaginary);
  }
  const std::span<const float> second =
      paired(0) ? std::span<const float>(best.imaginary) : std::span<const float>();
  const double cells = (2.0 * bowl.half + 1) * (2.0 * bowl.half + 1);
  normalise(best.real, second, sums, bowl.half, margin, cells * noise * noise + 1e-30);
}

// Offset of the vertex of the parabola through three equidistant values, the middle the highest.
double vertex(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? 0.5 * (before - after) / bend : 0;
}

// Local maxima in `core` of a tile of squared correlations; tile coordinates to a candidate by `to_image`.
template <class ToImage>
void collect(const std::vector<float>& squares, const cv::Rect& core, double min_correlation,
             const ToImage& to_image, std::vector<CraterCandidate>& found) {
  const auto min_square = static_cast<float>(min_correlation * min_correlation);
  const auto score = [](float square) {
    return std::copysign(std::sqrt(std::abs(double(square))), double(square));
  };
  for (int y = core.y; y < core.y + core.height; ++y) {
    const float* row = squares.data() + std::ptrdiff_t{y} * kTileSide;
    for (int x = core.x; x < core.x + core.width; ++x) {
      const float s = row[x];
      if (!(s >= min_square) || s < row[x - 1]) continue;
      const float *above = row + x - kTileSide, *below = row + x + kTileSide;
      // Ties: the first.
      if (!(s > above[-1] && s > above[0] && s > above[1] && s > row[x - 1] && s >= row[x + 1] &&
            s >= below[-1] && s >= below[0] && s >= below[1]))
        continue;
      const double at = score(s);
      found.push_back(to_image(x + vertex(score(row[x - 1]), at, score(row[x + 1])),
                               y + vertex(score(above[0]), at, score(below[0])), at));
    }
  }
}

// `made`: cache by size for all levels that have the same templates.
std::vector<const Bowl*> bowls_of_level(int level, const ShapeSearch& search, std::map<int, Bowl>& made) {
  std::vector<const Bowl*> bowls;
  const double shrink = std::exp2(level);
  const auto& shapes = level > 0 && search.large_shapes ? search.large_shapes : search.shapes;
  // The finest level also holds diameters below the first octave.
  for (int i = level == 0 ? -kSizesPerOctave : 0; i < kSizesPerOctave; ++i) {
    const double diameter = kMaxBowl / 2 * std::exp2(static_cast<double>(i) / kSizesPerOctave);
    if (diameter * shrink < search.limits.min_diameter * 0.95 ||
        diameter * shrink > search.limits.max_diameter * 1.05)
      continue;
    auto known = made.find(i);
    if (known == made.end()) known = made.emplace(i, make_bowl(diameter, shapes(diameter))).first;
    bowls.push_back(&known->second);
  }
  return bowls;
}

void search_level(const cv::Mat1f& image, double shrink_x, double shrink_y,
                  const std::vector<const Bowl*>& bowls, double min_correlation,
                  std::vector<CraterCandidate>& candidates) {
  int widest = 0;
  for (const Bowl* bowl : bowls) widest = std::max(widest, bowl->half);
  const int margin = widest + 1, core = kTileSide - 2 * margin - 2;
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
    ComplexTile tile, best, other;
    cv::Mat1f values(kTileSide, kTileSide, tile.real.data());
    padded(cv::Rect(x0, y0, kTileSide, kTileSide)).copyTo(values);
    values -= cv::mean(values)[0];
    const TileSums sums(tile.real);
    forward_transform(tile);
    const int first = margin + 1;
    const cv::Rect inside(first, first, std::min(core, image.cols - x0), std::min(core, image.rows - y0));
    for (const Bowl* bowl : bowls) {
      correlate(tile, sums, *bowl, margin, noise, best, other);
      const auto to_image = [&](double x, double y, double s) {
        return CraterCandidate{(x - first + x0 + 0.5) * shrink_x - 0.5,
                               (y - first + y0 + 0.5) * shrink_y - 0.5,
                               bowl->diameter * std::sqrt(shrink_x * shrink_y), s};
      };
      collect(best.real, inside, min_correlation, to_image, found[static_cast<std::size_t>(tile_index)]);
    }
  });
  for (const auto& part : found) candidates.insert(candidates.end(), part.begin(), part.end());
}

}  // namespace

std::vector<CraterCandidate> shape_candidates(const Pixels& image, const ShapeSearch& search) {
  std::vector<CraterCandidate> candidates;
  std::map<int, Bowl> made, made_large;
  cv::Mat1f at_level = as_matrix(image);
  for (int level = 0;; ++level) {
    if (std::min(at_level.cols, at_level.rows) < 8 ||
        kMaxBowl / 2 * std::exp2(level) > search.limits.max_diameter)
      break;
    const auto bowls = bowls_of_level(level, search, level > 0 ? made_large : made);
    cv::Mat1f searched = at_level, mean;
    if (search.level_mean > 0) {
      cv::GaussianBlur(at_level, mean, {}, search.level_mean, 0, cv::BORDER_REFLECT_101);
      searched = at_level - mean;
    }
    if (!bowls.empty())
      search_level(searched, static_cast<double>(image.columns()) / at_level.cols,
                   static_cast<double>(image.rows()) / at_level.rows, bowls, search.limits.min_correlation,
                   candidates);
    cv::Mat1f half;
    cv::resize(at_level, half, {(at_level.cols + 1) / 2, (at_level.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
    at_level = half;
  }
  return candidates;
}

}  // namespace waymark::pipeline
