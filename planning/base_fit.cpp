// SPDX-License-Identifier: Apache-2.0
#include "planning/base_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace waymark::planning {
namespace {

using Index = std::size_t;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kMaxRadius = 200;  // cells

Index at(std::int64_t i) {
  return static_cast<Index>(i);
}

struct Lag {
  std::int64_t columns, rows;
};

std::array<Lag, 4> lags(const BaseFootprint& base) {
  return {{{base.lag_x, 0}, {0, base.lag_y}, {base.lag_dx, base.lag_dy}, {base.lag_dx, -base.lag_dy}}};
}

// Sums are exact modulo 2^64, whatever the height of the window: unsigned numbers wrap.
using Sum = std::uint64_t;

struct RoundedHeights {
  Grid<std::int32_t> heights;  // quanta
  Grid<float> known;           // 1 or 0
};

[[gnu::always_inline]] inline RoundedHeights round_heights(const HeightWindow& heights, double quantum) {
  RoundedHeights rounded{Grid<std::int32_t>(heights.columns(), heights.rows()),
                         Grid<float>(heights.columns(), heights.rows())};
  const auto from = heights.cells();
  const auto to = rounded.heights.cells();
  const auto known = rounded.known.cells();
  for (Index i = 0; i < from.size(); ++i) {
    const bool has = from[i] > kNoHeight;
    known[i] = has ? 1.0F : 0.0F;
    to[i] = has ? static_cast<std::int32_t>(std::lrint(from[i] / quantum)) : 0;
  }
  return rounded;
}

// The largest value of each run of `length` cells along x or y, by doubling: O(log length) passes.
[[gnu::always_inline]] inline void slide_max(Grid<float>& grid, std::int64_t length, bool along_rows) {
  const std::int64_t stride = along_rows ? 1 : grid.columns();
  const auto cells = grid.cells();
  const auto count = static_cast<std::int64_t>(cells.size());
  for (std::int64_t done = 1; done < length;) {
    const std::int64_t shift = std::min(done, length - done) * stride;
    float* const a = cells.data();
    const float* const b = a + shift;
#pragma GCC ivdep  // b is ahead of a: what is read has not been written
    for (std::int64_t i = 0; i < count - shift; ++i) a[i] = std::max(a[i], b[i]);
    done += std::min(done, length - done);
  }
}

// The largest and smallest difference of heights over a lag within the box that begins at each cell.
struct DifferenceRange {
  Grid<float> max, negative_min;
};

[[gnu::always_inline]] inline DifferenceRange difference_range(const Grid<std::int32_t>& heights,
                                                               const Lag& lag, const BaseFootprint& base) {
  const std::int64_t columns = heights.columns(), rows = heights.rows();
  DifferenceRange range{Grid<float>(columns, rows), Grid<float>(columns, rows)};
  // The pair's cell with the smaller row comes first; the difference is along +columns.
  const std::int64_t up = lag.rows < 0 ? -lag.rows : 0, down = lag.rows > 0 ? lag.rows : 0;
  for (std::int64_t r = 0; r + up + down < rows; ++r) {
    const auto first = heights.row(r + up), second = heights.row(r + down);
    const auto max = range.max.row(r), min = range.negative_min.row(r);
    for (std::int64_t c = 0; c + lag.columns < columns; ++c) {
      const auto d = static_cast<float>(second[at(c + lag.columns)] - first[at(c)]);
      max[at(c)] = d;
      min[at(c)] = -d;
    }
  }
  const std::int64_t wide = 2 * base.half_columns + 1 - lag.columns;
  const std::int64_t high = 2 * base.half_rows + 1 - up - down;
  for (Grid<float>* grid : {&range.max, &range.negative_min}) {
    slide_max(*grid, wide, true);
    slide_max(*grid, high, false);
  }
  return range;
}

// Running sums of h, column * h and h^2 along each row; entry c is the sum of the cells before column c.
struct RowSums {
  std::int64_t stride;
  std::vector<Sum> h, xh, hh;

  explicit RowSums(const Grid<std::int32_t>& heights) : stride(heights.columns() + 1) {
    const Index size = at(stride * heights.rows());
    h.resize(size), xh.resize(size), hh.resize(size);
    for (std::int64_t r = 0; r < heights.rows(); ++r) {
      const auto row = heights.row(r);
      Sum a = 0, b = 0, c = 0;
      for (std::int64_t x = 0; x < heights.columns(); ++x) {
        const auto value = std::int64_t{row[at(x)]};
        a += static_cast<Sum>(value);
        b += static_cast<Sum>(value * x);
        c += static_cast<Sum>(value * value);
        const Index to = at(r * stride + x + 1);
        h[to] = a, xh[to] = b, hh[to] = c;
      }
    }
  }
};

struct DiscSums {
  std::vector<Sum> h, xh, yh, hh, slope;
  explicit DiscSums(std::int64_t columns)
      : h(at(columns)), xh(at(columns)), yh(at(columns)), hh(at(columns)), slope(at(columns)) {}
};

[[gnu::always_inline]] inline void add_row(std::vector<Sum>& to, const Sum* begin, const Sum* end) {
  Sum* const sum = to.data();
  const auto count = static_cast<std::int64_t>(to.size());
  for (std::int64_t i = 0; i < count; ++i) sum[i] += end[i] - begin[i];
}

// yh = sum of y h is a sum of partial sums: sum over k of the rows at least k from the middle, north less
// south.
[[gnu::always_inline]] inline void sum_discs(const RowSums& rows, const Window& inner, std::int64_t r,
                                             const BaseFootprint& base, DiscSums& sums) {
  for (std::vector<Sum>* all : {&sums.h, &sums.xh, &sums.yh, &sums.hh, &sums.slope})
    std::fill(all->begin(), all->end(), Sum{0});
  const auto count = static_cast<std::int64_t>(sums.h.size());
  for (auto dy = static_cast<std::int64_t>(base.half_widths.size()) - 1; dy >= 0; --dy) {
    const std::int64_t w = base.half_widths[at(dy)];
    for (const std::int64_t row : {r - dy, r + dy}) {
      const Index begin = at(row * rows.stride + inner.column - w), end = begin + at(2 * w + 1);
      add_row(sums.h, &rows.h[begin], &rows.h[end]);
      add_row(sums.xh, &rows.xh[begin], &rows.xh[end]);
      add_row(sums.hh, &rows.hh[begin], &rows.hh[end]);
      if (dy == 0) break;
    }
    if (dy == 0) break;
    const Index north = at((r - dy) * rows.stride + inner.column - w),
                south = at((r + dy) * rows.stride + inner.column - w);
    add_row(sums.slope, &rows.h[north], &rows.h[north + at(2 * w + 1)]);
    add_row(sums.slope, &rows.h[south + at(2 * w + 1)], &rows.h[south]);
    for (std::int64_t i = 0; i < count; ++i) sums.yh[at(i)] += sums.slope[at(i)];
  }
}

double signed_sum(Sum sum) {
  return static_cast<double>(static_cast<std::int64_t>(sum));
}

}  // namespace

std::int64_t BaseFootprint::cells() const {
  std::int64_t count = 0;
  for (std::size_t dy = 0; dy < half_widths.size(); ++dy) count += (2 * half_widths[dy] + 1) * (dy ? 2 : 1);
  return count;
}

double BaseFootprint::xx() const {
  double sum = 0;
  for (std::size_t dy = 0; dy < half_widths.size(); ++dy) {
    const auto w = static_cast<double>(half_widths[dy]);
    sum += w * (w + 1) * (2 * w + 1) / 3 * (dy ? 2 : 1);
  }
  return sum;
}

double BaseFootprint::yy() const {
  double sum = 0;
  for (std::size_t dy = 1; dy < half_widths.size(); ++dy)
    sum += 2 * static_cast<double>(dy * dy) * static_cast<double>(2 * half_widths[dy] + 1);
  return sum;
}

BaseFootprint make_base_footprint(double cell_x, double cell_y, double radius, double step) {
  BaseFootprint base{.cell_x = cell_x, .cell_y = cell_y, .half_widths = {}};
  const double wide = std::max(radius, 1.45 * std::max(cell_x, cell_y));
  if (!(wide / std::min(cell_x, cell_y) <= double(kMaxRadius)))
    throw Error(ErrorCode::input,
                fmt::format("the base of {:.3g} m is more than {} cells of {:.3g} m wide", 2 * wide,
                            2 * kMaxRadius, std::min(cell_x, cell_y)),
                "", "make the DEM coarser: gdalwarp -r average -tr");
  for (std::int64_t dy = 0; double(dy) * cell_y <= wide; ++dy) {
    const double y = double(dy) * cell_y;
    base.half_widths.push_back(static_cast<std::int64_t>(std::sqrt(wide * wide - y * y) / cell_x));
  }
  const auto cells = [](double length, double cell) {
    return std::max<std::int64_t>(1, std::llround(length / cell));
  };
  base.lag_x = cells(step, cell_x), base.lag_y = cells(step, cell_y);
  base.lag_dx = cells(step * M_SQRT1_2, cell_x), base.lag_dy = cells(step * M_SQRT1_2, cell_y);
  base.half_columns = std::max(base.half_widths[0], (base.lag_x + 1) / 2);
  base.half_rows = std::max(static_cast<std::int64_t>(base.half_widths.size()) - 1, (base.lag_y + 1) / 2);
  // A thousandth of a cell, rounded to a power of two, so that it is exact; at least 2^-15 m, so that every
  // height fits into 32 bits.
  base.quantum = std::exp2(std::max(-15.0, std::floor(std::log2(std::min(cell_x, cell_y) / 1024))));
  return base;
}

BaseRelief fit_base_directly(const HeightWindow& heights, std::int64_t column, std::int64_t row,
                             const BaseFootprint& base) {
  const auto rounded = [&](std::int64_t c, std::int64_t r) {
    return std::rint(heights(c, r) / base.quantum) * base.quantum;
  };
  const BaseRelief unknown{kNan, kNan, kNan, kNan};
  for (std::int64_t r = row - base.half_rows; r <= row + base.half_rows; ++r)
    for (std::int64_t c = column - base.half_columns; c <= column + base.half_columns; ++c)
      if (!(heights(c, r) > kNoHeight)) return unknown;
  const double middle = rounded(column, row);
  double h = 0, xh = 0, yh = 0;
  const auto visit = [&](auto&& cell) {
    const auto last = static_cast<std::int64_t>(base.half_widths.size()) - 1;
    for (std::int64_t dy = -last; dy <= last; ++dy)
      for (std::int64_t dx = -base.half_widths[at(std::abs(dy))]; dx <= base.half_widths[at(std::abs(dy))];
           ++dx)
        cell(double(dx), double(-dy), rounded(column + dx, row + dy) - middle);
  };
  visit([&](double x, double y, double z) { h += z, xh += x * z, yh += y * z; });
  const double mean = h / double(base.cells()), a = xh / base.xx(), b = yh / base.yy();
  double squares = 0;
  visit([&](double x, double y, double z) { squares += std::pow(z - mean - a * x - b * y, 2); });
  double step = 0;
  for (const Lag& lag : lags(base))
    for (std::int64_t r = row - base.half_rows; r <= row + base.half_rows; ++r)
      for (std::int64_t c = column - base.half_columns; c + lag.columns <= column + base.half_columns; ++c) {
        if (std::abs(r + lag.rows - row) > base.half_rows) continue;
        const double d = rounded(c + lag.columns, r + lag.rows) - rounded(c, r);
        step = std::max(step, std::abs(d - a * double(lag.columns) + b * double(lag.rows)));
      }
  return {static_cast<float>(a / base.cell_x), static_cast<float>(b / base.cell_y),
          static_cast<float>(std::sqrt(squares / double(base.cells()))), static_cast<float>(step)};
}

namespace {

// Blocks whose grids fit into the second-level cache.
constexpr std::int64_t kBlock = 128;

// The range of heights and the voids of the box that begins at each cell.
struct BoxChecks {
  bool has_voids = false, is_steep = false;  // anywhere in the block
  Grid<float> missing, top, negative_bottom;

  BoxChecks(const RoundedHeights& rounded, const BaseFootprint& base, double max_range) {
    const auto heights = rounded.heights.cells();
    const auto known = rounded.known.cells();
    has_voids = std::ranges::find(known, 0.0F) != known.end();
    const auto [low, high] = std::ranges::minmax(heights);
    is_steep = !(double(high) - double(low) < max_range);
    const std::int64_t columns = rounded.heights.columns(), rows = rounded.heights.rows();
    const auto slide = [&](Grid<float>& grid, auto&& value) {
      grid = Grid<float>(columns, rows);
      for (Index i = 0; i < heights.size(); ++i) grid.cells()[i] = value(i);
      slide_max(grid, 2 * base.half_columns + 1, true);
      slide_max(grid, 2 * base.half_rows + 1, false);
    };
    if (has_voids) slide(missing, [&](Index i) { return 1 - known[i]; });
    if (!is_steep) return;
    slide(top, [&](Index i) { return static_cast<float>(heights[i]); });
    slide(negative_bottom, [&](Index i) { return -static_cast<float>(heights[i]); });
  }

  bool is_missing(std::int64_t c, std::int64_t r) const { return has_voids && missing(c, r) > 0; }
  bool exceeds(std::int64_t c, std::int64_t r, double range) const {
    return is_steep && !(double(top(c, r)) + double(negative_bottom(c, r)) < range);
  }
};

[[gnu::always_inline]] inline void fit_block_body(const HeightWindow& all, const Window& inner,
                                                  const Window& block, const BaseFootprint& base,
                                                  Grid<BaseRelief>& relief) {
  const std::int64_t mx = base.half_columns, my = base.half_rows;
  HeightWindow heights(block.columns + 2 * mx, block.rows + 2 * my);
  for (std::int64_t r = 0; r < heights.rows(); ++r)
    std::ranges::copy(all.row(block.row - my + r).subspan(at(block.column - mx), at(heights.columns())),
                      heights.row(r).begin());
  const RoundedHeights rounded = round_heights(heights, base.quantum);
  const RowSums rows(rounded.heights);
  const auto all_lags = lags(base);
  std::vector<DifferenceRange> ranges;
  for (const Lag& lag : all_lags) ranges.push_back(difference_range(rounded.heights, lag, base));

  const auto n = static_cast<double>(base.cells());
  const double xx = base.xx(), yy = base.yy(), q = base.quantum;
  const double max_range = 0x1p32 / n;  // beyond, n sum(h^2) - sum(h)^2 may exceed 64 bits
  const BoxChecks checks(rounded, base, max_range);
  DiscSums sums(block.columns);
  const Window in_block{mx, my, block.columns, block.rows};
  for (std::int64_t y = 0; y < block.rows; ++y) {
    sum_discs(rows, in_block, my + y, base, sums);
    BaseRelief* const out = &relief(block.column - inner.column, block.row - inner.row + y);
    for (std::int64_t x = 0; x < block.columns; ++x) {
      if (checks.is_missing(x, y)) continue;
      if (checks.exceeds(x, y, max_range)) {
        out[x] = fit_base_directly(heights, mx + x, my + y, base);
        continue;
      }
      const Index i = at(x);
      const double xh = signed_sum(sums.xh[i] - static_cast<Sum>(mx + x) * sums.h[i]);
      const double yh = signed_sum(sums.yh[i]);
      const auto spread =
          static_cast<double>(static_cast<Sum>(base.cells()) * sums.hh[i] - sums.h[i] * sums.h[i]);
      const double a = xh / xx, b = yh / yy;
      const double squares = std::max(0.0, spread / n - a * xh - b * yh);
      double step = 0;
      for (Index k = 0; k < ranges.size(); ++k) {
        const double plane = a * double(all_lags[k].columns) - b * double(all_lags[k].rows);
        step = std::max(
            {step, double(ranges[k].max(x, y)) - plane, double(ranges[k].negative_min(x, y)) + plane});
      }
      out[x] = {static_cast<float>(a * q / base.cell_x), static_cast<float>(b * q / base.cell_y),
                static_cast<float>(std::sqrt(squares / n) * q), static_cast<float>(step * q)};
    }
  }
}

// The same bits with wider registers: most sums are of integers, and g++ keeps the order of the others. With
// the target attribute alone, g++ 12 forgets the -O3 of this file.
#ifdef __x86_64__
[[gnu::target("avx2"), gnu::optimize("O3")]] void fit_block_avx2(const HeightWindow& all, const Window& inner,
                                                                 const Window& block,
                                                                 const BaseFootprint& base,
                                                                 Grid<BaseRelief>& relief) {
  fit_block_body(all, inner, block, base, relief);
}
#endif

void fit_block(const HeightWindow& all, const Window& inner, const Window& block, const BaseFootprint& base,
               Grid<BaseRelief>& relief) {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2")) return fit_block_avx2(all, inner, block, base, relief);
#endif
  fit_block_body(all, inner, block, base, relief);
}

}  // namespace

Grid<BaseRelief> fit_base(const HeightWindow& heights, const Window& inner, const BaseFootprint& base) {
  Grid<BaseRelief> relief(inner.columns, inner.rows, {kNan, kNan, kNan, kNan});
  for (std::int64_t row = inner.row; row < inner.end_row(); row += kBlock)
    for (std::int64_t column = inner.column; column < inner.end_column(); column += kBlock)
      fit_block(heights, inner,
                {column, row, std::min(kBlock, inner.end_column() - column),
                 std::min(kBlock, inner.end_row() - row)},
                base, relief);
  return relief;
}

}  // namespace waymark::planning
