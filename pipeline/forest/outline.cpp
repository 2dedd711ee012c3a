// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crowns.hpp"

namespace waymark::pipeline {
namespace {

// Marks cells reached from outside through edges; the others are filled. Afterwards no two cells touch at a
// corner only, since one of the gaps beside it would be enclosed, so the ring never touches itself.
Grid<std::uint8_t> fill_holes(const Grid<std::uint8_t>& inside) {
  const std::int64_t columns = inside.columns() + 2, rows = inside.rows() + 2;
  Grid<std::uint8_t> in(columns, rows, 1);
  std::vector<CanopyCell> open{{0, 0}};
  in(0, 0) = 0;
  const auto visit = [&](std::int64_t c, std::int64_t r) {
    if (!in.contains(c, r) || !in(c, r)) return;
    if (inside.contains(c - 1, r - 1) && inside(c - 1, r - 1)) return;
    in(c, r) = 0;
    open.push_back({c, r});
  };
  while (!open.empty()) {
    const CanopyCell at = open.back();
    open.pop_back();
    visit(at.column - 1, at.row), visit(at.column + 1, at.row);
    visit(at.column, at.row - 1), visit(at.column, at.row + 1);
  }
  return in;
}

}  // namespace

Outline outline_of(const Grid<std::uint8_t>& inside, std::int64_t column, std::int64_t row) {
  const Grid<std::uint8_t> in = fill_holes(inside);
  Outline outline;
  CanopyCell start{-1, -1};
  for (std::int64_t r = 0; r < in.rows(); ++r)
    for (std::int64_t c = 0; c < in.columns(); ++c)
      if (in(c, r)) {
        if (start.column < 0) start = {c, r};
        ++outline.cells;
      }
  if (start.column < 0) return outline;
  // Follows cell edges with the inside to the left (north up), down the left side first.
  constexpr int kColumn[] = {0, 1, 0, -1}, kRow[] = {1, 0, -1, 0};  // south, east, north, west
  const auto is_in = [&](std::int64_t c, std::int64_t r) { return in.contains(c, r) && in(c, r) != 0; };
  // The two cells ahead of a corner in direction d: left and right.
  constexpr int kLeftColumn[] = {0, 0, -1, -1}, kLeftRow[] = {0, -1, -1, 0};
  constexpr int kRightColumn[] = {-1, 0, 0, -1}, kRightRow[] = {0, 0, -1, -1};
  CanopyCell at = start;
  int d = 0;
  do {
    outline.ring.push_back({at.column - 1 + column, at.row - 1 + row});
    do {  // straight edges get no intermediate points
      at.column += kColumn[d], at.row += kRow[d];
    } while (is_in(at.column + kLeftColumn[d], at.row + kLeftRow[d]) &&
             !is_in(at.column + kRightColumn[d], at.row + kRightRow[d]));
    const bool left = is_in(at.column + kLeftColumn[d], at.row + kLeftRow[d]);
    d = left ? (d + 3) % 4 : (d + 1) % 4;
  } while (!(at == start));
  return outline;
}

}  // namespace waymark::pipeline
