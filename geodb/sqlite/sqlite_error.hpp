// SPDX-License-Identifier: Apache-2.0
#pragma once
struct sqlite3;
namespace waymark::geodb::sqlite {

/// Throws Error for the last failure of a connection: a full disk, a locked, damaged or foreign file.
[[noreturn]] void fail(sqlite3* database);

/// Throws Error{input} for a statement that exceeded its StepLimit.
[[noreturn]] void fail_endless(sqlite3* database);

/// Calls fail() unless `result` is one of SQLITE_OK, SQLITE_ROW, SQLITE_DONE.
void check(sqlite3* database, int result);

}  // namespace waymark::geodb::sqlite
