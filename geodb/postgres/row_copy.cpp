// SPDX-License-Identifier: Apache-2.0
#include "geodb/postgres/row_copy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <cstring>

#include "core/error.hpp"
#include "geodb/geopackage/geometry_blob.hpp"
#include "geodb/sqlite/row_inserter.hpp"
#include "geodb/sqlite/sql_text.hpp"

namespace waymark::geodb::postgres {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;
constexpr std::size_t kHeaderBytes = 8;     // of a GeoPackage geometry without its envelope
constexpr std::size_t kEnvelopeBytes = 32;  // x and y

/// Rows in PostgreSQL's binary format, big-endian.
class RowBuffer {
 public:
  void begin(std::size_t fields) { put(static_cast<std::uint16_t>(fields)); }
  void add(std::int64_t value) { add_fixed(static_cast<std::uint64_t>(value)); }
  void add(double value) { add_fixed(std::bit_cast<std::uint64_t>(value)); }
  void add_null() { put(static_cast<std::uint32_t>(-1)); }
  void add(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
  }
  std::string& bytes() { return bytes_; }

 private:
  void add_fixed(std::uint64_t value) {
    put(std::uint32_t{8});
    put(value);
  }
  template <class T>
  void put(T value) {
    for (int shift = 8 * (static_cast<int>(sizeof(T)) - 1); shift >= 0; shift -= 8)
      bytes_ += static_cast<char>(value >> shift);
  }
  std::string bytes_;
};

std::string_view as_text(std::span<const std::byte> blob) {
  return {reinterpret_cast<const char*>(blob.data()), blob.size()};
}

/// Returns the WKB within a GeoPackage geometry; PostGIS reads it.
std::string_view wkb_of(std::span<const std::byte> blob, const TableLayout& table) {
  constexpr std::size_t envelope_bytes[] = {0, 32, 48, 48, 64};
  const std::size_t kind = blob.size() > 3 ? (std::to_integer<std::size_t>(blob[3]) >> 1) & 7 : 7;
  if (kind > 4 || blob.size() < kHeaderBytes + envelope_bytes[kind])
    throw Error(ErrorCode::input, "a row has no valid geometry", "table " + table.name,
                "`waymark validate` lists the errors of the map");
  return as_text(blob.subspan(kHeaderBytes + envelope_bytes[kind]));
}

void put_double(std::string& bytes, double value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// Returns a GeoPackage geometry as Waymark writes it: all but points have an envelope.
std::string geopackage_blob(std::string_view wkb, std::int32_t srs_id) {
  std::string blob{'G', 'P', 0, 1};
  char raw[sizeof srs_id];
  std::memcpy(raw, &srs_id, sizeof srs_id);
  blob.append(raw, sizeof srs_id);
  blob += wkb;
  if (point_of(std::as_bytes(std::span(blob)))) return blob;
  const auto box = envelope(std::as_bytes(std::span(blob)));
  if (!box || box->empty()) return blob;
  std::string with_envelope = blob.substr(0, kHeaderBytes);
  with_envelope[3] = 3;
  with_envelope.reserve(blob.size() + kEnvelopeBytes);
  for (const double side : {box->min_x, box->max_x, box->min_y, box->max_y}) put_double(with_envelope, side);
  return with_envelope.append(wkb);
}

std::uint64_t from_big_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char c : bytes) value = value << 8 | static_cast<unsigned char>(c);
  return value;
}

}  // namespace

void copy_rows(const sqlite::Database& map, const TableLayout& table, const Connection& server,
               const std::string& target) {
  std::string select = "SELECT ";
  if (table.has_row_number) select += "rowid, ";
  for (const Column& column : table.columns) select += quote_identifier(column.name) + ", ";
  select.resize(select.size() - 2);
  sqlite::Statement row = map.prepare(select + " FROM " + quote_identifier(table.name) + " ORDER BY rowid");
  server.start_copy(fmt::format("COPY {} ({}) FROM STDIN (FORMAT binary)", target, column_list(table)));
  RowBuffer buffer;
  const int first = table.has_row_number ? 1 : 0;
  while (row.step()) {
    buffer.begin(table.columns.size() + static_cast<std::size_t>(first));
    if (table.has_row_number) buffer.add(row.integer(0));
    int index = first;
    for (const Column& column : table.columns) {
      if (row.null(index))
        buffer.add_null();
      else if (column.kind == ValueKind::integer)
        buffer.add(row.integer(index));
      else if (column.kind == ValueKind::real)
        buffer.add(row.real(index));
      else if (column.kind == ValueKind::text)
        buffer.add(row.text(index));
      else if (column.kind == ValueKind::bytes)
        buffer.add(as_text(row.blob(index)));
      else
        buffer.add(wkb_of(row.blob(index), table));
      ++index;
    }
    if (buffer.bytes().size() < kBufferBytes) continue;
    server.send(buffer.bytes());
    buffer.bytes().clear();
  }
  server.send(buffer.bytes());
  server.finish_copy();
}

void fetch_rows(const Connection& server, const TableLayout& table, const sqlite::Database& map,
                std::int32_t srs_id) {
  std::vector<std::string> selected, inserted;
  if (table.has_row_number) selected.emplace_back("row_number"), inserted.emplace_back("rowid");
  for (const Column& column : table.columns) {
    selected.push_back(column.kind == ValueKind::geometry ? "ST_AsBinary(" + quoted(column.name) + ", 'NDR')"
                                                          : quoted(column.name));
    inserted.push_back(quote_identifier(column.name));
  }
  sqlite::RowInserter rows(map, table.name, inserted);
  std::vector<std::string> bytes(rows.max_rows() * inserted.size());  // of the rows that wait
  const std::size_t first = table.has_row_number ? 1 : 0;
  server.read_copy(fmt::format("COPY (SELECT {} FROM {} ORDER BY {}) TO STDOUT (FORMAT binary)",
                               fmt::join(selected, ", "), quoted(table.name), quoted(table.key)),
                   [&](const Connection::Fields& fields) {
                     sqlite::Statement& row = rows.statement();
                     for (std::size_t i = 0; i < fields.size(); ++i) {
                       const int parameter = rows.before_first() + static_cast<int>(i) + 1;
                       std::string& own = bytes[rows.row() * inserted.size() + i];
                       const ValueKind kind = i < first ? ValueKind::integer : table.columns[i - first].kind;
                       if (!fields[i])
                         row.bind(parameter, nullptr);
                       else if (kind == ValueKind::integer)
                         row.bind(parameter, static_cast<std::int64_t>(from_big_endian(*fields[i])));
                       else if (kind == ValueKind::real)
                         row.bind(parameter, std::bit_cast<double>(from_big_endian(*fields[i])));
                       else if (kind == ValueKind::text)
                         row.bind(parameter, own = *fields[i]);
                       else if (kind == ValueKind::bytes)
                         row.bind(parameter, std::as_bytes(std::span(own = *fields[i])));
                       else
                         row.bind(parameter,
                                  std::as_bytes(std::span(own = geopackage_blob(*fields[i], srs_id))));
                     }
                     rows.end_row();
                   });
  rows.flush();
}

}  // namespace waymark::geodb::postgres
