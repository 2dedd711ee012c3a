// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
namespace waymark::inline core {

/// Throws Error{usage} if the output exists and is one of these files, which it would replace. Empty names
/// and addresses are ignored.
void keep_inputs(const std::filesystem::path& output, const std::vector<std::string>& inputs);

}  // namespace waymark::inline core
