// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::importers {

/// Returns a path that can be opened any number of times and read in any order. Thread-safe.
/// - For /vsistdin/ (with options or not) that is a nameless temporary copy of standard input. All calls
///   share it; it disappears with the process.
/// - Other paths are returned unchanged.
/// - Throws Error{input} if standard input is empty or a terminal, Error{output} if the disk is full.
std::string seekable_path(const std::string& path);

}  // namespace waymark::importers
