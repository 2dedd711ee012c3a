// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/sqlite.hpp"
#include "landmarks/landmark_type.hpp"
namespace waymark {

/// A map describes its own landmark types (waymark_type, waymark_feature, waymark_attribute), so that a
/// program can read a map whose types it was not built with.
void write_types(const sqlite::Database& database, const TypeRegistry& types);

/// Throws Error where a type is not fit to be one.
TypeRegistry read_types(const sqlite::Database& database);

}  // namespace waymark
