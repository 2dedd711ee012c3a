// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/search_image.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::workflows {
namespace {

/// Window that is read, and the part of it whose objects are kept.
struct Piece {
  Window read, own;
};

constexpr std::int64_t kMinMargin = 64;  // pixels: shadows and backgrounds of small objects
constexpr double kPieceRatio = 16;       // side of a piece over the largest diameter in it
constexpr double kReach = 1.5;           // diameters about the centre that a detector looks at

/// Returns the length of equal parts, as few as possible, none longer than `max_part`.
std::int64_t equal_part(std::int64_t length, std::int64_t max_part) {
  const std::int64_t parts = (length + max_part - 1) / max_part;
  return (length + parts - 1) / parts;
}

std::vector<Piece> pieces_of(const ImageInfo& info, std::int64_t side, double max_diameter) {
  if (std::max(info.columns, info.rows) <= side) {
    const Window all{0, 0, info.columns, info.rows};
    return {{all, all}};
  }
  const auto wanted = static_cast<std::int64_t>(std::ceil(kReach * max_diameter));
  const std::int64_t margin = std::clamp(wanted, kMinMargin, 3 * side / 8);
  const std::int64_t across = equal_part(info.columns, side - 2 * margin),
                     down = equal_part(info.rows, side - 2 * margin);
  std::vector<Piece> pieces;
  for (std::int64_t row = 0; row < info.rows; row += down)
    for (std::int64_t column = 0; column < info.columns; column += across) {
      const Window own{column, row, std::min(across, info.columns - column), std::min(down, info.rows - row)};
      const std::int64_t left = std::max<std::int64_t>(0, column - margin),
                         top = std::max<std::int64_t>(0, row - margin);
      const std::int64_t right = std::min(info.columns, own.end_column() + margin),
                         low = std::min(info.rows, own.end_row() + margin);
      pieces.push_back({{left, top, right - left, low - top}, own});
    }
  return pieces;
}

bool in(const Window& window, const PixelEllipse& outline) {
  return window.contains(std::llround(outline.x), std::llround(outline.y));
}

std::vector<Detection> search_piece(const ImageSource& image, const Piece& piece, double min, double max,
                                    const ObjectDetector& find) {
  std::vector<Detection> found = find(image.read(piece.read), min, max);
  for (Detection& one : found) {
    one.outline.x += static_cast<double>(piece.read.column);
    one.outline.y += static_cast<double>(piece.read.row);
  }
  if (piece.read != piece.own)
    std::erase_if(found, [&](const Detection& one) { return !in(piece.own, one.outline); });
  return found;
}

/// Returns the image reduced by `factor`: means of squares, pixels without data left out.
Pixels reduced(const ImageSource& image, std::int64_t factor) {
  const ImageInfo& info = image.info();
  Pixels small(info.columns / factor, info.rows / factor, std::numeric_limits<float>::quiet_NaN());
  for (std::int64_t row = 0; row < small.rows(); ++row) {
    const Pixels strip = image.read({0, row * factor, small.columns() * factor, factor});
    for (std::int64_t column = 0; column < small.columns(); ++column) {
      double sum = 0;
      int count = 0;
      for (std::int64_t y = 0; y < factor; ++y)
        for (std::int64_t x = 0; x < factor; ++x)
          if (const float value = strip(column * factor + x, y); !std::isnan(value)) sum += value, ++count;
      if (count > 0) small(column, row) = static_cast<float>(sum / count);
    }
  }
  return small;
}

std::vector<Detection> search_reduced(const ImageSource& image, std::int64_t factor, double min, double max,
                                      const ObjectDetector& find) {
  const auto f = static_cast<double>(factor);
  std::vector<Detection> found = find(reduced(image, factor), min / f, max / f);
  for (Detection& one : found) {
    PixelEllipse& o = one.outline;
    o.x = (o.x + 0.5) * f - 0.5;
    o.y = (o.y + 0.5) * f - 0.5;
    o.major *= f;
    o.minor *= f;
    one.covariance *= f * f;
    one.diameter_sd *= f;
    if (one.shadow_reach)
      one.shadow_reach = MeasuredValue{one.shadow_reach->value * f, one.shadow_reach->sd * f};
  }
  return found;
}

bool more_certain(const Detection& a, const Detection& b) {
  if (a.confidence != b.confidence) return a.confidence > b.confidence;
  if (a.outline.y != b.outline.y) return a.outline.y < b.outline.y;
  if (a.outline.x != b.outline.x) return a.outline.x < b.outline.x;
  return a.outline.major > b.outline.major;
}

bool same_object(const PixelEllipse& a, const PixelEllipse& b) {
  const double smaller = std::min(a.diameter(), b.diameter()), larger = std::max(a.diameter(), b.diameter());
  return larger < 1.5 * smaller && std::hypot(a.x - b.x, a.y - b.y) < 0.25 * smaller;
}

/// Drops the less certain of two equal objects from different searches. `found` is sorted by certainty.
void drop_duplicates(std::vector<Detection>& found, const std::vector<int>& searches_by_rank) {
  std::vector<std::size_t> by_row(found.size());
  for (std::size_t i = 0; i < by_row.size(); ++i) by_row[i] = i;
  std::ranges::sort(by_row, {}, [&](std::size_t i) { return found[i].outline.y; });
  std::vector<char> dropped(found.size(), 0);
  for (std::size_t i = 0; i < by_row.size(); ++i)
    for (std::size_t j = i + 1; j < by_row.size(); ++j) {
      const auto &a = found[by_row[i]].outline, &b = found[by_row[j]].outline;
      if (b.y - a.y > 0.25 * a.diameter()) break;
      if (searches_by_rank[by_row[i]] != searches_by_rank[by_row[j]] && same_object(a, b))
        dropped[std::max(by_row[i], by_row[j])] = 1;
    }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    if (dropped[i] == 0) found[kept++] = found[i];
  found.resize(kept);
}

std::vector<Detection> merge_searches(std::vector<std::vector<Detection>>& searches) {
  std::vector<std::pair<Detection, int>> all;
  for (std::size_t s = 0; s < searches.size(); ++s)
    for (Detection& one : searches[s]) all.emplace_back(std::move(one), static_cast<int>(s));
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return more_certain(a.first, b.first); });
  std::vector<Detection> found;
  std::vector<int> search;
  for (auto& [one, s] : all) {
    found.push_back(std::move(one));
    search.push_back(s);
  }
  if (searches.size() > 1) drop_duplicates(found, search);
  return found;
}

}  // namespace

std::vector<Detection> search_image(const ImageSource& image, const ImageSearch& search,
                                    const ObjectDetector& find) {
  const ImageInfo& info = image.info();
  const bool whole = std::max(info.columns, info.rows) <= search.piece;
  const double asked = search.max_diameter > 0 ? search.max_diameter
                                               : 0.6 * static_cast<double>(std::min(info.columns, info.rows));
  const double fits = static_cast<double>(search.piece) / kPieceRatio;
  // beyond what fits, so that a large crater is not taken for a smaller one inside it
  const double max = whole ? search.max_diameter : std::min(asked, 1.5 * fits);
  const auto pieces = pieces_of(info, search.piece, max);
  std::vector<std::vector<Detection>> found(pieces.size());
  const std::int64_t factor = (std::max(info.columns, info.rows) + search.piece - 1) / search.piece;
  const double smallest = std::max({fits, search.min_diameter, 8.0 * static_cast<double>(factor)});
  const bool reduce = !whole && search.reduce_for_large && asked > 1.5 * fits && smallest < asked;
  pipeline::ProgressMeter meter(search.progress, "search_image",
                                static_cast<std::int64_t>(pieces.size()) + (reduce ? 1 : 0));
  tbb::task_arena arena(search.threads > 0 ? search.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
      found[i] = search_piece(image, pieces[i], search.min_diameter, max, find);
      meter.add(1);
    });
    if (!reduce) return;
    found.push_back(search_reduced(image, factor, smallest, asked, find));
    meter.add(1);
  });
  meter.finish();
  return merge_searches(found);
}

std::vector<Window> sample_windows(const ImageInfo& info, std::int64_t side) {
  if (std::max(info.columns, info.rows) <= side) return {{0, 0, info.columns, info.rows}};
  std::vector<Window> windows;
  const std::int64_t columns = std::min(side, info.columns), rows = std::min(side, info.rows);
  for (const auto& [x, y] : {std::pair{0.5, 0.5}, {0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}})
    windows.push_back({static_cast<std::int64_t>(x * static_cast<double>(info.columns - columns)),
                       static_cast<std::int64_t>(y * static_cast<double>(info.rows - rows)), columns, rows});
  return windows;
}

Brightness measure_brightness(const ImageSource& image) {
  constexpr std::int64_t kStrip = std::int64_t{1} << 22;  // pixels read at once
  const ImageInfo& info = image.info();
  Brightness all{.pixels = info.columns * info.rows,
                 .darkest = std::numeric_limits<float>::infinity(),
                 .brightest = -std::numeric_limits<float>::infinity()};
  const std::int64_t rows = std::max<std::int64_t>(1, kStrip / std::max<std::int64_t>(1, info.columns));
  for (std::int64_t row = 0; row < info.rows; row += rows) {
    const Pixels strip = image.read({0, row, info.columns, std::min(rows, info.rows - row)});
    for (const float value : strip.cells()) {
      if (std::isnan(value)) {
        ++all.no_data;
        continue;
      }
      all.darkest = std::min(all.darkest, value);
      all.brightest = std::max(all.brightest, value);
      all.saturated += info.saturated > 0 && value >= static_cast<float>(info.saturated);
    }
  }
  return all;
}

}  // namespace waymark::workflows
