// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <filesystem>
#include "pipeline/engine/runner.hpp"
namespace waymark::importers {

/// Returns a hasher that keeps the sums of large files in a folder, so that the calls of a plan read them
/// once.
/// - A sum counts for the same names, sizes and times of all files that hash_file() reads, and for the same
///   inodes of local ones; on the network the server states the time.
/// - Files that were changed in the last `settled`, folders, standard input, archives, and servers without
///   times are read at each call.
/// - `hash` is asked for the others. Throws what it throws, Error{output} if the folder cannot be written.
pipeline::FileHasher keep_hashes(pipeline::FileHasher hash, std::filesystem::path folder,
                                 std::chrono::seconds settled = std::chrono::seconds(2));

}  // namespace waymark::importers
