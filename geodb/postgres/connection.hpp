// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>
struct pg_conn;
struct pg_result;
namespace waymark::geodb::postgres {

/// Database and schema in which a map is stored.
struct Address {
  std::string connection;          ///< as libpq reads it: "dbname=maps host=gis", or a postgresql:// address
  std::string schema = "waymark";  ///< one map each
};

/// Reads "pg:dbname=maps host=gis schema=alps"; `schema=` is ours, the rest goes to libpq.
/// Throws Error{usage} for a schema that is not of a-z, 0-9 and _.
Address parse_address(std::string_view text);
/// Returns true for a name that begins with "pg:".
bool is_address(std::string_view text);

/// Connection to a PostgreSQL server. Failures throw Error that names the database, never the password.
class Connection {
 public:
  explicit Connection(const Address& address);

  void execute(const std::string& script) const;
  /// Returns the rows of a query as text; `std::nullopt` is NULL.
  using Rows = std::vector<std::vector<std::optional<std::string>>>;
  Rows rows(const std::string& query, const std::vector<std::string>& parameters = {}) const;
  bool exists(const std::string& query, const std::vector<std::string>& parameters = {}) const {
    return !rows(query, parameters).empty();
  }

  /// Starts `COPY ... FROM STDIN (FORMAT binary)`.
  void start_copy(const std::string& statement) const;
  void send(std::string_view bytes) const;
  void finish_copy() const;
  /// Calls `visit` with the fields of each row of `COPY ... TO STDOUT (FORMAT binary)`.
  using Fields = std::vector<std::optional<std::string_view>>;
  void read_copy(const std::string& statement, const std::function<void(const Fields&)>& visit) const;

 private:
  [[noreturn]] void fail(const std::string& doing) const;
  struct Finish {
    void operator()(pg_conn* connection) const;
  };
  std::string where_;
  std::unique_ptr<pg_conn, Finish> connection_;
};

}  // namespace waymark::geodb::postgres
