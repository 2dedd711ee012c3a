// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::test {

/// Returns the bytes of a sound map of rocks, with an image and a track.
const std::string& sound_map();

/// Reads a file of edits, three bytes of a position and four of content each; applies them to the sound map,
/// and reads and checks all of it.
void read_edited_map(const std::string& edits);

/// Reads a file of SQL statements, which may change the schema, too; applies those that SQLite accepts to the
/// sound map, and reads and checks all of it. Statements get 100,000 steps.
void read_altered_map(const std::string& sql);

}  // namespace waymark::test
