// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
namespace waymark::pipeline {

/// Returns a path in `folder` that no other thread, process or machine uses, for a file to be renamed later.
/// The name identifies the process, so that files left by killed processes are recognised.
std::filesystem::path temporary_path(const std::filesystem::path& folder);

/// Removes temporary files that killed processes of this machine left in `folder`.
void remove_stale_files(const std::filesystem::path& folder);

/// Throws Error{output} with the system's reason.
void write_file(const std::filesystem::path& path, std::string_view bytes);
std::string read_file(const std::filesystem::path& path);  ///< throws Error{input}

}  // namespace waymark::pipeline
