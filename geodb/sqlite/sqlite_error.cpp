// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/sqlite_error.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "core/error.hpp"

namespace waymark::geodb::sqlite {
namespace {

struct Explanation {
  ErrorCode code;
  std::string problem, hint;
};

Explanation endless() {
  return {ErrorCode::input, "a query takes far longer than the size of this map explains",
          "a table of the map may be a view or have a trigger that never ends: copy its rows into a table"};
}

Explanation explain(sqlite3* database) {
  const std::string message = sqlite3_errmsg(database);
  switch (sqlite3_errcode(database)) {
    case SQLITE_FULL:
      return {ErrorCode::output, "the disk is full", "free some space, or write to another disk"};
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return {ErrorCode::environment, "another program is changing this map", "close it, or try again later"};
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {ErrorCode::output, "this map cannot be changed: " + message,
              "check the permissions of file and folder"};
    case SQLITE_NOTADB:
      return {ErrorCode::input, "this is not a GeoPackage", "a map ends in .gpkg and is an SQLite file"};
    case SQLITE_CORRUPT:
      return {ErrorCode::input, "this map is damaged: " + message,
              "restore it from a copy, or run its job again"};
    case SQLITE_CANTOPEN:
      return {ErrorCode::input, "cannot open the map: " + message, "check that it is there and may be read"};
    case SQLITE_IOERR: {
      const int cause = sqlite3_system_errno(database);
      if (cause == ENOSPC || cause == EDQUOT)
        return {ErrorCode::output, "the disk is full", "free some space, or write to another disk"};
      return {ErrorCode::environment,
              fmt::format("reading or writing failed: {} ({})", message, std::strerror(cause)),
              "check the disk"};
    }
    case SQLITE_AUTH:
      return {ErrorCode::input, "a trigger that is not Waymark's would change other rows of this map",
              "list them: SELECT name, sql FROM sqlite_master WHERE type = 'trigger'; and drop it"};
    case SQLITE_TOOBIG:
      return {ErrorCode::input, "a text or blob of this map has more than 256 MB",
              "the map is damaged or hostile: run its job again"};
    case SQLITE_INTERRUPT:
      return endless();
    case SQLITE_NOMEM:
      return {ErrorCode::environment, "out of memory", "close other programs"};
    default:
      return {ErrorCode::input, "the map has unexpected contents: " + message,
              "`waymark validate` lists its errors"};
  }
}

[[noreturn]] void throw_at_file(sqlite3* database, const Explanation& why) {
  const char* file = sqlite3_db_filename(database, "main");
  throw Error(why.code, why.problem, file ? file : "", why.hint);
}

}  // namespace

void fail(sqlite3* database) {
  throw_at_file(database, explain(database));
}
void fail_endless(sqlite3* database) {
  throw_at_file(database, endless());
}

void check(sqlite3* database, int result) {
  if (result != SQLITE_OK && result != SQLITE_ROW && result != SQLITE_DONE) fail(database);
}

}  // namespace waymark::geodb::sqlite
