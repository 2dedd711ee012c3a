// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite.hpp"

#include <sqlite3.h>

#include <array>
#include <cmath>
#include <fstream>

#include "core/error.hpp"
#include "geodb/geometry_functions.hpp"
#include "geodb/sqlite_error.hpp"

namespace waymark::sqlite {
namespace {

// Asks often for a lock another program holds, for half a minute: SQLite's own handler soon asks so rarely
// that a busy writer can shut a reader out.
int wait_for_lock(void*, int tries) {
  constexpr int kPause = 2, kPatience = 30'000;  // ms
  sqlite3_sleep(kPause);
  return tries < kPatience / kPause;
}

// Bytes 18 and 19 of an SQLite file are 2 where it keeps a write-ahead log
// (https://sqlite.org/fileformat.html).
bool keeps_log(const std::filesystem::path& path) {
  std::array<char, 20> header{};
  std::ifstream(path, std::ios::binary).read(header.data(), header.size());
  return header[18] == 2;
}

// A path as a file: URI, so that a name with ? or % stays a name.
std::string uri(const std::filesystem::path& path, std::string_view query) {
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string out = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '/' || c == '.' || c == '-' || c == '_')
      out += c;
    else
      (out += '%') += {digits[byte >> 4], digits[byte & 15]};
  }
  return out + std::string(query);
}

int open_flags(OpenMode mode) {
  switch (mode) {
    case OpenMode::read:
      return SQLITE_OPEN_READONLY;
    case OpenMode::update:
      return SQLITE_OPEN_READWRITE;
    case OpenMode::create:
      return SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  }
  return 0;
}

// A reader that meets the journal of a writer which is just finishing takes it for one left by a killed
// process, which it may not roll back. A moment later it is gone. SQLite finds out before the first row.
int patiently(sqlite3* database, const auto& action) {
  constexpr int kTries = 50;
  int result = action();
  for (int i = 0; i < kTries && result == SQLITE_READONLY; ++i) {
    if (sqlite3_extended_errcode(database) != SQLITE_READONLY_ROLLBACK) break;
    sqlite3_sleep(2);
    result = action();
  }
  return result;
}

const char* settings(OpenMode mode) {
  switch (mode) {
    case OpenMode::read:
      return "PRAGMA query_only = ON;";
    // Without spilling, readers are shut out only while the transaction commits.
    case OpenMode::update:
      return "PRAGMA foreign_keys = ON; PRAGMA cache_spill = OFF;";
    case OpenMode::create:
      return "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;"
             "PRAGMA locking_mode = EXCLUSIVE;";
  }
  return "";
}

}  // namespace

Statement::Statement(sqlite3* database, std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  check(database, patiently(database, [&] {
          return sqlite3_prepare_v3(database, sql.data(), static_cast<int>(sql.size()),
                                    SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
        }));
  statement_.reset(statement);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

void Statement::bind(int parameter, double value) {
  sqlite3_bind_double(statement_.get(), parameter, value);
}
void Statement::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter, value);
}
void Statement::bind(int parameter, std::nullptr_t) {
  sqlite3_bind_null(statement_.get(), parameter);
}
void Statement::bind(int parameter, std::string_view text) {
  sqlite3_bind_text64(statement_.get(), parameter, text.empty() ? "" : text.data(), text.size(),
                      SQLITE_STATIC, SQLITE_UTF8);
}
void Statement::bind(int parameter, std::span<const std::byte> blob) {
  sqlite3_bind_blob64(statement_.get(), parameter, blob.data(), blob.size(), SQLITE_STATIC);
}

bool Statement::step() {
  const int result =
      patiently(sqlite3_db_handle(statement_.get()), [&] { return sqlite3_step(statement_.get()); });
  if (result == SQLITE_ROW) return true;
  sqlite3_reset(statement_.get());  // lets locks go, and keeps the error
  if (result != SQLITE_DONE) fail(sqlite3_db_handle(statement_.get()));
  return false;
}
void Statement::reset() {
  sqlite3_reset(statement_.get());
}

bool Statement::null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}
double Statement::real(int column) const {
  return null(column) ? std::nan("") : sqlite3_column_double(statement_.get(), column);
}
std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}
std::string_view Statement::text(int column) const {
  const void* bytes = sqlite3_column_text(statement_.get(), column);
  return {static_cast<const char*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}
std::span<const std::byte> Statement::blob(int column) const {
  const void* bytes = sqlite3_column_blob(statement_.get(), column);
  return {static_cast<const std::byte*>(bytes),
          static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}
std::optional<double> Statement::optional_real(int column) const {
  if (null(column)) return std::nullopt;
  return sqlite3_column_double(statement_.get(), column);
}

Database::Database(const std::filesystem::path& path, OpenMode mode) {
  sqlite3* handle = nullptr;
  const bool unlogged = mode == OpenMode::read && keeps_log(path);
  const int result = sqlite3_open_v2(uri(path, unlogged ? "?immutable=1" : "").c_str(), &handle,
                                     open_flags(mode) | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (!handle) throw Error(ErrorCode::environment, "out of memory", path.string());
  check(handle, result);
  sqlite3_extended_result_codes(handle, 0);
  sqlite3_busy_handler(handle, wait_for_lock, nullptr);
  add_geometry_functions(handle);
  execute(settings(mode));
}

void Database::Close::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}

void Database::close() {
  sqlite3* handle = handle_.release();
  if (const int result = sqlite3_close(handle); result != SQLITE_OK) {
    handle_.reset(handle);
    check(handle, result);
  }
}

void Database::execute(std::string_view script) const {
  check(handle_.get(), sqlite3_exec(handle_.get(), std::string(script).c_str(), nullptr, nullptr, nullptr));
}

std::int64_t Database::integer(std::string_view sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::int64_t Database::last_id() const {
  return sqlite3_last_insert_rowid(handle_.get());
}

bool Database::has_table(std::string_view name) const {
  Statement statement = prepare("SELECT 1 FROM sqlite_master WHERE type IN ('table', 'view') AND name = ?");
  statement.bind(1, name);
  return statement.step();
}

Transaction::Transaction(const Database& database) : database_(&database) {
  database.execute("BEGIN IMMEDIATE");
}
Transaction::~Transaction() {
  if (!open_) return;
  try {
    database_->execute("ROLLBACK");
  } catch (const Error&) {  // SQLite has already rolled back, as it does when the disk is full
  }
}
void Transaction::commit() {
  database_->execute("COMMIT");
  open_ = false;
}

}  // namespace waymark::sqlite
