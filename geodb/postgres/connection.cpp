// SPDX-License-Identifier: Apache-2.0
#include "geodb/postgres/connection.hpp"

#include <libpq-fe.h>

#include <algorithm>
#include <bit>
#include <sstream>

#include "core/error.hpp"

namespace waymark::geodb::postgres {
namespace {

struct Clear {
  void operator()(PGresult* result) const { PQclear(result); }
};
using Result = std::unique_ptr<PGresult, Clear>;

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

template <class T>
T big_endian(std::string_view bytes) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<T>((static_cast<std::uint64_t>(value) << 8) | static_cast<unsigned char>(bytes[i]));
  return value;
}

// Signature, flags and the length of an extension that nobody uses ("COPY", binary format).
constexpr std::string_view kSignature{"PGCOPY\n\377\r\n\0\0\0\0\0\0\0\0\0", 19};

}  // namespace

bool is_address(std::string_view text) {
  return text.starts_with("pg:") || text.starts_with("PG:");
}

Address parse_address(std::string_view text) {
  Address address;
  std::istringstream words{std::string(text.substr(3))};
  for (std::string word; words >> word;) {
    if (word.starts_with("schema="))
      address.schema = word.substr(7);
    else
      address.connection += (address.connection.empty() ? "" : " ") + word;
  }
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (address.schema.empty() || !std::ranges::all_of(address.schema, allowed) ||
      address.schema.starts_with("pg_"))
    throw Error(ErrorCode::usage, "'" + address.schema + "' is not a schema for a map", "pg: address",
                "use a-z, 0-9 and _, not beginning with pg_");
  return address;
}

void Connection::Finish::operator()(pg_conn* connection) const {
  PQfinish(connection);
}

Connection::Connection(const Address& address) : connection_(PQconnectdb(address.connection.c_str())) {
  const char* name = PQdb(connection_.get());
  where_ = "database " + std::string(name ? name : "") + ", schema " + address.schema;
  if (PQstatus(connection_.get()) != CONNECTION_OK)
    throw Error(ErrorCode::environment,
                "cannot connect to PostgreSQL: " + one_line(PQerrorMessage(connection_.get())), where_,
                "check host, dbname and user; passwords go to ~/.pgpass or PGPASSWORD");
  PQsetNoticeProcessor(
      connection_.get(), [](void*, const char*) {}, nullptr);
  execute("SET client_encoding = 'UTF8'");
}

void Connection::fail(const std::string& doing) const {
  throw Error(ErrorCode::environment, doing + ": " + one_line(PQerrorMessage(connection_.get())), where_,
              "nothing was changed; check rights, space and the connection");
}

void Connection::execute(const std::string& script) const {
  const Result result(PQexec(connection_.get(), script.c_str()));
  const auto status = PQresultStatus(result.get());
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) fail("PostgreSQL refuses");
}

Connection::Rows Connection::rows(const std::string& query,
                                  const std::vector<std::string>& parameters) const {
  std::vector<const char*> values;
  for (const std::string& parameter : parameters) values.push_back(parameter.c_str());
  const Result result(PQexecParams(connection_.get(), query.c_str(), static_cast<int>(values.size()), nullptr,
                                   values.data(), nullptr, nullptr, 0));
  const auto status = PQresultStatus(result.get());
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) fail("PostgreSQL refuses");
  Rows rows(static_cast<std::size_t>(PQntuples(result.get())));
  for (int r = 0; r < PQntuples(result.get()); ++r)
    for (int c = 0; c < PQnfields(result.get()); ++c)
      rows[static_cast<std::size_t>(r)].push_back(
          PQgetisnull(result.get(), r, c) != 0 ? std::nullopt
                                               : std::optional(std::string(PQgetvalue(result.get(), r, c))));
  return rows;
}

void Connection::start_copy(const std::string& statement) const {
  const Result result(PQexec(connection_.get(), statement.c_str()));
  if (PQresultStatus(result.get()) != PGRES_COPY_IN) fail("cannot copy rows");
  send(kSignature);
}

void Connection::send(std::string_view bytes) const {
  if (PQputCopyData(connection_.get(), bytes.data(), static_cast<int>(bytes.size())) != 1)
    fail("cannot copy rows");
}

void Connection::finish_copy() const {
  send(std::string_view("\377\377", 2));
  if (PQputCopyEnd(connection_.get(), nullptr) != 1) fail("cannot copy rows");
  bool failed = false;
  while (const Result result{PQgetResult(connection_.get())})
    failed = failed || PQresultStatus(result.get()) != PGRES_COMMAND_OK;
  if (failed) fail("cannot copy rows");
}

void Connection::read_copy(const std::string& statement,
                           const std::function<void(const Fields&)>& visit) const {
  const Result started(PQexec(connection_.get(), statement.c_str()));
  if (PQresultStatus(started.get()) != PGRES_COPY_OUT) fail("cannot read rows");
  bool first = true;
  Fields fields;
  char* message = nullptr;
  int bytes = 0;
  while ((bytes = PQgetCopyData(connection_.get(), &message, 0)) > 0) {
    const std::unique_ptr<char, decltype(&PQfreemem)> owner(message, &PQfreemem);
    std::string_view rest(message, static_cast<std::size_t>(bytes));
    if (first) rest.remove_prefix(std::min(rest.size(), kSignature.size()));
    first = false;
    while (rest.size() >= 2) {
      const auto count = big_endian<std::int16_t>(rest);
      rest.remove_prefix(2);
      if (count < 0) break;  // the end
      fields.clear();
      for (std::int16_t i = 0; i < count; ++i) {
        const auto length = big_endian<std::int32_t>(rest);
        rest.remove_prefix(4);
        if (length < 0) {
          fields.push_back(std::nullopt);
        } else {
          fields.emplace_back(rest.substr(0, static_cast<std::size_t>(length)));
          rest.remove_prefix(static_cast<std::size_t>(length));
        }
      }
      visit(fields);
    }
  }
  if (bytes == -2) fail("cannot read rows");
  bool failed = false;
  while (const Result result{PQgetResult(connection_.get())})
    failed = failed || PQresultStatus(result.get()) != PGRES_COMMAND_OK;
  if (failed) fail("cannot read rows");
}

}  // namespace waymark::geodb::postgres
