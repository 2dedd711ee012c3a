// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::apps {

/// Returns "waymark 0.1.0", and a line each for compiler, libraries and optional parts.
std::string version_as_text();

/// Returns an object: version, compiler, build_type, processor, libraries (versions by name, null: not
/// there), decompressors (whether they are there, by name).
std::string version_as_json();

}  // namespace waymark::apps
