// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::geodb {

/// Returns the version of the SQLite library that is loaded: "3.40.1".
std::string sqlite_version();
/// Returns the version of the client library of PostgreSQL that is loaded: "15.8".
std::string libpq_version();

}  // namespace waymark::geodb
