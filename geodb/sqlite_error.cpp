// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite_error.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.hpp"

namespace waymark::sqlite {
namespace {

struct Explanation {
  ErrorCode code;
  std::string problem, hint;
};

Explanation explain(sqlite3* database) {
  const std::string said = sqlite3_errmsg(database);
  switch (sqlite3_errcode(database)) {
    case SQLITE_FULL:
      return {ErrorCode::output, "the disk is full", "free some space, or write to another disk"};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {ErrorCode::environment, "another program is changing this map", "close it, or try again later"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {ErrorCode::output, "this map cannot be changed: " + said,
              "check the permissions of file and folder"};
    case SQLITE_NOTADB:
      return {ErrorCode::input, "this is not a GeoPackage", "a map ends in .gpkg and is an SQLite file"};
    case SQLITE_CORRUPT:
      return {ErrorCode::input, "this map is damaged: " + said,
              "restore it from a copy, or run its job again"};
    case SQLITE_CANTOPEN:
      return {ErrorCode::input, "cannot open the map: " + said, "check that it is there and may be read"};
    case SQLITE_IOERR: {
      const int cause = sqlite3_system_errno(database);
      if (cause == ENOSPC || cause == EDQUOT)
        return {ErrorCode::output, "the disk is full", "free some space, or write to another disk"};
      return {ErrorCode::environment,
              fmt::format("reading or writing failed: {} ({})", said, std::strerror(cause)),
              "check the disk"};
    }
    case SQLITE_NOMEM:
      return {ErrorCode::environment, "out of memory", "close other programs"};
    default:
      return {ErrorCode::input, "the map does not hold what a map should: " + said,
              "`waymark validate` lists what is wrong with it"};
  }
}

}  // namespace

void fail(sqlite3* database) {
  const auto [code, problem, hint] = explain(database);
  const char* file = sqlite3_db_filename(database, "main");
  throw Error(code, problem, file ? file : "", hint);
}

void check(sqlite3* database, int result) {
  if (result != SQLITE_OK && result != SQLITE_ROW && result != SQLITE_DONE) fail(database);
}

}  // namespace waymark::sqlite
