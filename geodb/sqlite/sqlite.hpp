// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
struct sqlite3;
struct sqlite3_stmt;
namespace waymark::geodb::sqlite {

/// Instructions of SQLite's virtual machine that one execution of a statement may take. A foreign file may
/// hold views and triggers that never end.
struct StepLimit {
  std::uint64_t max_steps = 0;
  std::uint64_t steps = 0;  ///< of the statement that is being executed
};

/// Prepared statement. Parameters count from 1, columns from 0, as in SQLite. Failures throw Error.
class Statement {
 public:
  /// Without `limit`, the statement may take any number of instructions.
  Statement(sqlite3* database, std::string_view sql, StepLimit* limit = nullptr);

  void bind(int parameter, double value);  ///< NaN becomes NULL
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, int value) { bind(parameter, std::int64_t{value}); }
  /// Binds bytes that must outlive the statement's reset or next binding.
  void bind(int parameter, std::string_view text);
  /// Deleted: a temporary string would not outlive the statement's execution.
  template <std::same_as<std::string> T>
  void bind(int parameter, T&& gone) = delete;
  void bind(int parameter, std::span<const std::byte> blob);
  void bind(int parameter, std::nullptr_t);
  template <class T>
  void bind(int parameter, const std::optional<T>& value) {
    value ? bind(parameter, *value) : bind(parameter, nullptr);
  }
  void bind_all(auto&&... values) {
    int parameter = 0;
    (bind(++parameter, std::forward<decltype(values)>(values)), ...);
  }

  bool step();  ///< true: a row is available; false: done, and the statement is reset
  void run() {
    while (step()) continue;
  }
  void reset();

  bool null(int column) const;
  double real(int column) const;  ///< NULL becomes NaN
  std::int64_t integer(int column) const;
  /// Returns a text that is valid until the next step or reset.
  std::string_view text(int column) const;
  std::span<const std::byte> blob(int column) const;
  std::optional<double> optional_real(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
  StepLimit* limit_ = nullptr;
  std::uint64_t steps_ = 0;  ///< of this execution
};

enum class OpenMode {
  read,    ///< never writes; a file in WAL mode is opened as immutable
  update,  ///< the file must exist
  create,  ///< a new file that no other process reads: no journal, no locks, no flushing
};

/// Connection with the geometry functions that GeoPackage triggers call. A statement that takes far more
/// instructions than a scan of the file throws Error{input}; in a new file it may take any number. Values of
/// a map are at most 256 MB. A change throws Error{input} if a foreign trigger would change more than
/// indexes.
class Database {
 public:
  Database(const std::filesystem::path& path, OpenMode mode);

  Statement prepare(std::string_view sql) const { return {handle_.get(), sql, limit_.get()}; }
  void execute(std::string_view script) const;  ///< any number of statements
  /// Returns the first column of the first row; 0 without rows.
  std::int64_t integer(std::string_view sql) const;
  std::int64_t last_id() const;
  bool has_table(std::string_view name) const;  ///< or view
  void close();                                 ///< throws Error on failure, unlike the destructor

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<StepLimit> limit_;  ///< outlives the statements of `handle_`
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Returns a new database that is no map and that the caller removes; `VACUUM INTO` writes its content
/// elsewhere.
Database scratch_database(const std::filesystem::path& path);

/// Transaction; the destructor rolls it back unless commit() was called.
class Transaction {
 public:
  explicit Transaction(const Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  const Database* database_;
  bool open_ = true;
};

}  // namespace waymark::geodb::sqlite
