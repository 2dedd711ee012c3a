// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
namespace waymark::inline core {

/// Returns the folder that holds a file; "." for a plain name.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Returns whether the disk of `output` has so little space that it explains a failure.
bool disk_is_full(const std::filesystem::path& output);
[[noreturn]] void fail_full_disk(const std::filesystem::path& output);

/// Throws Error{output} for a result that could not be written. `reason` is the message of the system or a
/// library; a full disk is detected and reported instead of reason and hint.
[[noreturn]] void fail_output(
    const std::filesystem::path& output, const std::string& reason,
    const std::string& hint = "check that the folder can be written to, or write elsewhere");

/// Throws Error{output} for a failed call of the system with this errno.
[[noreturn]] void fail_output(const std::filesystem::path& output, int error_number);

}  // namespace waymark::inline core
