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
namespace waymark::sqlite {

/// A prepared statement. Parameters count from 1, columns from 0, as in SQLite. Errors are thrown as Error.
class Statement {
 public:
  Statement(sqlite3* database, std::string_view sql);

  void bind(int parameter, double value);  ///< NaN becomes NULL
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, int value) { bind(parameter, std::int64_t{value}); }
  /// The bytes must live until the statement is reset or bound anew.
  void bind(int parameter, std::string_view text);
  /// A string that nobody keeps would be gone before the statement runs.
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

  bool step();  ///< true: there is a row to read; false: done, and the statement is reset
  void run() {
    while (step()) continue;
  }
  void reset();

  bool null(int column) const;
  double real(int column) const;  ///< NULL becomes NaN
  std::int64_t integer(int column) const;
  /// Valid until the next step or reset.
  std::string_view text(int column) const;
  std::span<const std::byte> blob(int column) const;
  std::optional<double> optional_real(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

enum class OpenMode {
  read,    ///< never writes; a file in WAL mode that nobody has open is read without its log
  update,  ///< the file must exist
  create,  ///< a new file nobody else reads yet: no journal, no locks, no waiting for the disk
};

/// A connection that knows the geometry functions GeoPackage triggers call.
class Database {
 public:
  Database(const std::filesystem::path& path, OpenMode mode);

  Statement prepare(std::string_view sql) const { return Statement(handle_.get(), sql); }
  void execute(std::string_view script) const;  ///< any number of statements
  std::int64_t integer(
      std::string_view sql) const;  ///< the first column of the first row; 0 where there is none
  std::int64_t last_id() const;
  bool has_table(std::string_view name) const;  ///< or view
  void close();                                 ///< reports what a destructor could not

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Begins a transaction; rolls it back unless commit() was called.
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

}  // namespace waymark::sqlite
