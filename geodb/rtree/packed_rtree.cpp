// SPDX-License-Identifier: Apache-2.0
#include "geodb/rtree/packed_rtree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb {
namespace {

// Node: depth of the tree (only in the root, node 1), count of cells, then per cell the rowid (leaf) or child
// node and min x, max x, min y, max y; all big-endian, padded with zeros.
constexpr std::size_t kCellBytes = 8 + 4 * 4;
constexpr std::size_t kNodeHeaderBytes = 4;
constexpr std::int64_t kRoot = 1;

struct Cell {
  std::int64_t id = 0;
  std::array<float, 4> box{};  ///< min x, max x, min y, max y
};

float rounded_down(double v) {
  const auto f = static_cast<float>(v);
  return static_cast<double>(f) > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float rounded_up(double v) {
  return -rounded_down(-v);
}

std::array<float, 4> bounding_box(std::span<const Cell> cells) {
  auto box = cells[0].box;
  for (const Cell& cell : cells) {
    for (const std::size_t low : {0u, 2u}) box[low] = std::min(box[low], cell.box[low]);
    for (const std::size_t high : {1u, 3u}) box[high] = std::max(box[high], cell.box[high]);
  }
  return box;
}

template <class T>
void put_big_endian(std::byte*& at, T value) {
  auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
  std::ranges::reverse(bytes);
  at = std::ranges::copy(bytes, at).out;
}

class Packer {
 public:
  Packer(const sqlite::Database& database, const std::string& index)
      : node_(database.prepare("INSERT OR REPLACE INTO " + quote_identifier(index + "_node") +
                               " VALUES (?, ?)")),
        parent_(database.prepare("INSERT INTO " + quote_identifier(index + "_parent") + " VALUES (?, ?)")),
        rowid_(database.prepare("INSERT INTO " + quote_identifier(index + "_rowid") + " VALUES (?, ?)")),
        bytes_(static_cast<std::size_t>(database.integer(
            "SELECT length(data) FROM " + quote_identifier(index + "_node") + " WHERE nodeno = 1"))) {}

  /// Writes one level of the tree with `count` cells from `next`. Returns the cells of the level above.
  std::vector<Cell> pack(std::size_t count, const std::function<Cell()>& next, int depth) {
    const std::size_t capacity = (bytes_.size() - kNodeHeaderBytes) / kCellBytes;
    const std::size_t nodes = std::max<std::size_t>(1, (count + capacity - 1) / capacity);
    std::vector<Cell> above, part;
    above.reserve(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {  // evenly filled, so that none is nearly empty
      part.resize((i + 1) * count / nodes - i * count / nodes);
      std::ranges::generate(part, next);
      const std::int64_t number = nodes == 1 ? kRoot : next_node_++;
      write(number, part, nodes == 1 ? depth : 0);
      sqlite::Statement& link = depth == 0 ? rowid_ : parent_;
      for (const Cell& cell : part) {
        link.bind_all(cell.id, number);
        link.run();
      }
      if (nodes > 1) above.push_back({number, bounding_box(part)});
    }
    return above;
  }

 private:
  void write(std::int64_t number, std::span<const Cell> cells, int depth) {
    std::ranges::fill(bytes_, std::byte{0});
    std::byte* at = bytes_.data();
    put_big_endian(at, static_cast<std::uint16_t>(depth));
    put_big_endian(at, static_cast<std::uint16_t>(cells.size()));
    for (const Cell& cell : cells) {
      put_big_endian(at, cell.id);
      for (const float side : cell.box) put_big_endian(at, side);
    }
    node_.bind_all(number, std::span<const std::byte>(bytes_));
    node_.run();
  }

  sqlite::Statement node_, parent_, rowid_;
  std::vector<std::byte> bytes_;  ///< of one node; SQLite chose its size for the empty root
  std::int64_t next_node_ = kRoot + 1;
};

Cell cell_of(std::int64_t id, double min_x, double max_x, double min_y, double max_y) {
  return {id, {rounded_down(min_x), rounded_up(max_x), rounded_down(min_y), rounded_up(max_y)}};
}

void pack_all(const sqlite::Database& database, std::string_view table, std::size_t count,
              const std::function<Cell()>& next) {
  if (count == 0) return;
  Packer packer(database, "rtree_" + std::string(table) + "_geom");
  std::vector<Cell> level = packer.pack(count, next, 0);
  for (int depth = 1; !level.empty(); ++depth) {
    auto cell = level.begin();
    level = packer.pack(
        level.size(), [&] { return *cell++; }, depth);
  }
}

}  // namespace

void fill_rtree(const sqlite::Database& database, std::string_view table, std::span<const IndexedBox> boxes) {
  auto box = boxes.begin();
  pack_all(database, table, boxes.size(), [&] {
    const auto& [id, min_x, max_x, min_y, max_y] = *box++;
    return cell_of(id, min_x, max_x, min_y, max_y);
  });
}

void fill_rtree(const sqlite::Database& database, std::string_view table) {
  const std::string rows = " FROM " + quote_identifier(table) + " WHERE geom IS NOT NULL";
  sqlite::Statement row = database.prepare("SELECT id, geom" + rows + " ORDER BY id");
  pack_all(database, table, static_cast<std::size_t>(database.integer("SELECT count(*)" + rows)), [&] {
    row.step();
    const Envelope box = envelope(row.blob(1)).value();
    return cell_of(row.integer(0), box.min_x, box.max_x, box.min_y, box.max_y);
  });
}

std::vector<IndexedBox> boxes_of(const sqlite::Database& database, std::string_view table) {
  std::vector<IndexedBox> boxes;
  sqlite::Statement row = database.prepare("SELECT id, geom FROM " + quote_identifier(table) +
                                           " WHERE geom IS NOT NULL ORDER BY id");
  while (row.step())
    if (const auto box = envelope(row.blob(1)))
      boxes.push_back({row.integer(0), box->min_x, box->max_x, box->min_y, box->max_y});
  return boxes;
}

bool has_row_order(const sqlite::Database& database, std::string_view table) {
  const std::string index = "rtree_" + std::string(table) + "_geom";
  sqlite::Statement leaf = database.prepare("SELECT data FROM " + quote_identifier(index + "_node") +
                                            " WHERE nodeno IN (SELECT nodeno FROM " +
                                            quote_identifier(index + "_rowid") + ") ORDER BY nodeno");
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  while (leaf.step()) {
    const auto bytes = leaf.blob(0);
    const auto big_endian = [&](std::size_t at, std::size_t count) {
      std::uint64_t value = 0;
      for (std::size_t i = at; i < at + count && i < bytes.size(); ++i)
        value = value << 8 | std::to_integer<std::uint64_t>(bytes[i]);
      return value;
    };
    for (std::size_t cell = 0; cell < big_endian(2, 2); ++cell) {
      const auto id = static_cast<std::int64_t>(big_endian(kNodeHeaderBytes + cell * kCellBytes, 8));
      if (id <= last) return false;
      last = id;
    }
  }
  return true;
}

}  // namespace waymark::geodb
