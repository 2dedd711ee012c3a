// SPDX-License-Identifier: Apache-2.0
#include "geodb/sqlite/sqlite.hpp"

#include <sqlite3.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string_view>

#include "core/error.hpp"
#include "geodb/geopackage/geometry_functions.hpp"
#include "geodb/sqlite/sqlite_error.hpp"

namespace waymark::geodb::sqlite {
namespace {

// Polls for a lock of another process for 30 s. SQLite's own handler increases its pauses, so that a busy
// writer can starve a reader.
int wait_for_lock(void*, int tries) {
  constexpr int kPause = 2, kTimeout = 30'000;  // ms
  sqlite3_sleep(kPause);
  return tries < kTimeout / kPause;
}

// Bytes 18 and 19 of an SQLite file are 2 in WAL mode (https://sqlite.org/fileformat.html).
bool uses_wal(const std::filesystem::path& path) {
  std::array<char, 20> header{};
  std::ifstream(path, std::ios::binary).read(header.data(), header.size());
  return header[18] == 2;
}

// Returns a path as a file: URI with ? and % escaped.
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

// A reader may mistake the journal of a committing writer for one of a killed process, which it may not roll
// back. The journal soon disappears, so the action is retried. SQLite detects this before the first row.
int retry_while_locked(sqlite3* database, const auto& action) {
  constexpr int kTries = 50;
  int result = action();
  for (int i = 0; i < kTries && result == SQLITE_READONLY; ++i) {
    if (sqlite3_extended_errcode(database) != SQLITE_READONLY_ROLLBACK) break;
    sqlite3_sleep(2);
    result = action();
  }
  return result;
}

const char* pragmas(OpenMode mode) {
  switch (mode) {
    case OpenMode::read:
      return "PRAGMA query_only = ON;";
    // Without spilling, readers are blocked only during the commit.
    case OpenMode::update:
      return "PRAGMA foreign_keys = ON; PRAGMA cache_spill = OFF;";
    case OpenMode::create:
      return "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;"
             "PRAGMA locking_mode = EXCLUSIVE;";
  }
  return "";
}

// The widest scan of a map takes about 5 instructions per byte; the constant is half a second of computing.
constexpr std::uint64_t kStepsPerByte = 100, kMinSteps = 20'000'000;
constexpr int kStepsPerCheck = 100'000;

std::uint64_t max_steps(const std::filesystem::path& path) {
  std::error_code unknown;
  const auto bytes = std::filesystem::file_size(path, unknown);
  return kMinSteps + (unknown ? 0 : kStepsPerByte * bytes);
}

// Longest text or blob of a map, bytes: a tile, a record of a run with all its inputs.
constexpr int kMaxLength = 256 << 20;

// Authorizer of SQLite: what a trigger or view of the map may do while the map is changed. Ours, and those of
// GDAL and the GeoPackage standard, keep spatial indexes and counts, note moved landmarks and name new ones.
int authorize(void*, int action, const char* table, const char* column, const char*, const char* trigger) {
  if (trigger == nullptr) return SQLITE_OK;
  const std::string_view name = table ? table : "";
  switch (action) {
    case SQLITE_SELECT:
    case SQLITE_READ:
    case SQLITE_FUNCTION:
    case SQLITE_RECURSIVE:
      return SQLITE_OK;
    case SQLITE_UPDATE:
      if (column && std::string_view(column) == "uid") return SQLITE_OK;
      [[fallthrough]];
    case SQLITE_INSERT:
    case SQLITE_DELETE:
      return name.starts_with("rtree_") || name == "waymark_moved" || name == "gpkg_ogr_contents"
                 ? SQLITE_OK
                 : SQLITE_DENY;
    default:
      return SQLITE_DENY;
  }
}

// Progress handler of SQLite: interrupts the statement if it returns other than 0.
int count_steps(void* data) {
  auto& limit = *static_cast<StepLimit*>(data);
  limit.steps += kStepsPerCheck;
  return limit.steps > limit.max_steps;
}

}  // namespace

Statement::Statement(sqlite3* database, std::string_view sql, StepLimit* limit) : limit_(limit) {
  sqlite3_stmt* statement = nullptr;
  check(database, retry_while_locked(database, [&] {
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
  if (limit_ && !sqlite3_stmt_busy(statement_.get())) steps_ = 0;
  if (limit_) limit_->steps = steps_;
  const int result =
      retry_while_locked(sqlite3_db_handle(statement_.get()), [&] { return sqlite3_step(statement_.get()); });
  if (limit_) {
    steps_ += static_cast<std::uint32_t>(
        sqlite3_stmt_status(statement_.get(), SQLITE_STMTSTATUS_VM_STEP, /*reset=*/1));
    if (result == SQLITE_ROW && steps_ > limit_->max_steps) {
      sqlite3_reset(statement_.get());
      fail_endless(sqlite3_db_handle(statement_.get()));
    }
  }
  if (result == SQLITE_ROW) return true;
  sqlite3_reset(statement_.get());  // releases locks and preserves the error
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
  const bool immutable = mode == OpenMode::read && uses_wal(path);
  const int result = sqlite3_open_v2(uri(path, immutable ? "?immutable=1" : "").c_str(), &handle,
                                     open_flags(mode) | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  handle_.reset(handle);
  if (!handle) throw Error(ErrorCode::environment, "out of memory", path.string());
  check(handle, result);
  sqlite3_extended_result_codes(handle, 0);
  sqlite3_busy_handler(handle, wait_for_lock, nullptr);
  add_geometry_functions(handle);
  if (mode != OpenMode::create) {
    limit_ = std::make_unique<StepLimit>(StepLimit{.max_steps = max_steps(path)});
    sqlite3_progress_handler(handle, kStepsPerCheck, count_steps, limit_.get());
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kMaxLength);
  }
  if (mode == OpenMode::update) sqlite3_set_authorizer(handle, authorize, nullptr);
  execute(pragmas(mode));
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
  if (limit_) limit_->steps = 0;
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

Database scratch_database(const std::filesystem::path& path) {
  return {path, OpenMode::create};
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

}  // namespace waymark::geodb::sqlite
