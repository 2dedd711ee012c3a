// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <string_view>
namespace waymark {

/// A path in `folder` that no other thread, process or machine uses, for something to be renamed later. The
/// name tells who made it, so that leftovers of killed processes can be told from work in progress.
std::filesystem::path aside_path(const std::filesystem::path& folder);

/// Removes what killed processes of this machine left in `folder`.
void remove_leftovers(const std::filesystem::path& folder);

/// Throws Error{output} with the system's reason.
void write_file(const std::filesystem::path& path, std::string_view bytes);
std::string read_file(const std::filesystem::path& path);  ///< throws Error{input}

}  // namespace waymark
