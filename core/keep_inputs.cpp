// SPDX-License-Identifier: Apache-2.0
#include "core/keep_inputs.hpp"

#include "core/error.hpp"

namespace waymark::inline core {

void keep_inputs(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (output.empty() || input.empty() || !std::filesystem::equivalent(output, input, missing)) continue;
    throw Error(ErrorCode::usage, "the output would replace the input " + input, output.string(),
                "name another file");
  }
}

}  // namespace waymark::inline core
