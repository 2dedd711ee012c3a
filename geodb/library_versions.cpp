// SPDX-License-Identifier: Apache-2.0
#include "geodb/library_versions.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>
#include <sqlite3.h>

namespace waymark::geodb {

std::string sqlite_version() {
  return sqlite3_libversion();
}

std::string libpq_version() {
  const int number = PQlibVersion();  // 150008
  return fmt::format("{}.{}", number / 10000, number % 10000);
}

}  // namespace waymark::geodb
