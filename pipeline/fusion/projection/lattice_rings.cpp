// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/lattice_rings.hpp"

#include <array>
#include <optional>

namespace waymark::pipeline {
namespace {

using Cells = Grid<std::uint8_t>;

struct Step {
  std::int64_t column, row;
};
constexpr std::array<Step, 4> kRightDownLeftUp{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

bool is_marked(const Cells& cells, std::int64_t c, std::int64_t r) {
  return cells.contains(c, r) && cells(c, r) != 0;
}

// Returns the cells of value `of` connected to the first by edges.
Cells flood(const Cells& cells, LatticeCorner first, std::uint8_t of) {
  Cells filled(cells.columns(), cells.rows(), 0);
  std::vector<LatticeCorner> todo{first};
  filled(first.column, first.row) = 1;
  while (!todo.empty()) {
    const LatticeCorner at = todo.back();
    todo.pop_back();
    for (const Step& step : kRightDownLeftUp) {
      const LatticeCorner next{at.column + step.column, at.row + step.row};
      if (!cells.contains(next.column, next.row) || filled(next.column, next.row)) continue;
      if (cells(next.column, next.row) != of) continue;
      filled(next.column, next.row) = 1;
      todo.push_back(next);
    }
  }
  return filled;
}

// Returns a column of a hole. The part's grid has an empty frame.
std::optional<std::int64_t> hole_column(const Cells& part) {
  const Cells outside = flood(part, {0, 0}, 0);
  for (std::int64_t r = 0; r < part.rows(); ++r)
    for (std::int64_t c = 0; c < part.columns(); ++c)
      if (!part(c, r) && !outside(c, r)) return c;
  return std::nullopt;
}

// Traces the boundary of a part without holes; its cells are on the right.
std::vector<LatticeCorner> trace_boundary(const Cells& part, LatticeCorner start) {
  std::vector<LatticeCorner> ring{start};
  LatticeCorner at = start;
  int heading = 0;  // right: the start is the top left corner of a topmost cell
  do {
    at.column += kRightDownLeftUp[static_cast<std::size_t>(heading)].column;
    at.row += kRightDownLeftUp[static_cast<std::size_t>(heading)].row;
    ring.push_back(at);
    // The cells ahead on the right and on the left of the corner.
    const auto ahead = [&](bool right) {
      const int side = heading + (right ? 0 : 3);
      constexpr std::array<Step, 4> kCell{{{0, 0}, {-1, 0}, {-1, -1}, {0, -1}}};
      const Step& cell = kCell[static_cast<std::size_t>(side % 4)];
      return is_marked(part, at.column + cell.column, at.row + cell.row);
    };
    if (!ahead(true))
      heading = (heading + 1) % 4;
    else if (ahead(false))
      heading = (heading + 3) % 4;
  } while (!(at == start && heading == 0));
  return ring;
}

void add_rings(const Cells& cells, std::vector<std::vector<LatticeCorner>>& rings) {
  Cells left = cells;
  for (std::int64_t r = 0; r < cells.rows(); ++r)
    for (std::int64_t c = 0; c < cells.columns(); ++c) {
      if (!left(c, r)) continue;
      Cells part = flood(left, {c, r}, 1);
      for (std::int64_t y = 0; y < cells.rows(); ++y)
        for (std::int64_t x = 0; x < cells.columns(); ++x)
          if (part(x, y)) left(x, y) = 0;
      const auto hole = hole_column(part);
      if (!hole) {
        rings.push_back(trace_boundary(part, {c, r}));
        continue;
      }
      Cells west = part, east = part;
      for (std::int64_t y = 0; y < cells.rows(); ++y)
        for (std::int64_t x = 0; x < cells.columns(); ++x) (x <= *hole ? east : west)(x, y) = 0;
      add_rings(west, rings);
      add_rings(east, rings);
    }
}

}  // namespace

std::vector<std::vector<LatticeCorner>> lattice_rings(const Grid<std::uint8_t>& marked) {
  Cells framed(marked.columns() + 2, marked.rows() + 2, 0);
  for (std::int64_t r = 0; r < marked.rows(); ++r)
    for (std::int64_t c = 0; c < marked.columns(); ++c) framed(c + 1, r + 1) = marked(c, r) ? 1 : 0;
  std::vector<std::vector<LatticeCorner>> rings;
  add_rings(framed, rings);
  for (auto& ring : rings)
    for (LatticeCorner& corner : ring) --corner.column, --corner.row;
  return rings;
}

}  // namespace waymark::pipeline
