// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark::inline core {

/// Opens a file for reading and writing that has no name and disappears with its descriptor, even if the
/// process is killed. Returns the descriptor, or -1 with errno.
int open_nameless_file(const std::filesystem::path& folder);

}  // namespace waymark::inline core
