// SPDX-License-Identifier: Apache-2.0
#include "geodb/geopackage/geometry_functions.hpp"

#include <sqlite3.h>

#include "geodb/geopackage/geometry_blob.hpp"

namespace waymark::geodb {
namespace {

std::optional<Envelope> envelope_of(sqlite3_value* value) {
  const void* bytes = sqlite3_value_blob(value);
  return envelope(
      {static_cast<const std::byte*>(bytes), static_cast<std::size_t>(sqlite3_value_bytes(value))});
}

void is_empty(sqlite3_context* result, int, sqlite3_value** geometry) {
  const auto box = envelope_of(*geometry);
  box ? sqlite3_result_int(result, box->empty()) : sqlite3_result_null(result);
}

template <double Envelope::*side>
void bound(sqlite3_context* result, int, sqlite3_value** geometry) {
  const auto box = envelope_of(*geometry);
  box && !box->empty() ? sqlite3_result_double(result, (*box).*side) : sqlite3_result_null(result);
}

}  // namespace

void add_geometry_functions(sqlite3* database) {
  const auto add = [database](const char* name, auto function) {
    sqlite3_create_function_v2(database, name, 1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_INNOCUOUS,
                               nullptr, function, nullptr, nullptr, nullptr);
  };
  add("ST_IsEmpty", is_empty);
  add("ST_MinX", bound<&Envelope::min_x>);
  add("ST_MaxX", bound<&Envelope::max_x>);
  add("ST_MinY", bound<&Envelope::min_y>);
  add("ST_MaxY", bound<&Envelope::max_y>);
}

}  // namespace waymark::geodb
