// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "core/options/option_table.hpp"
#include "pipeline/engine/step.hpp"
namespace waymark::pipeline {

/// Returns the options of a step in the order of declaration.
std::vector<OptionRow> option_table(const Step& step);

/// Sets options from a JSON object and checks them. `location` is the location of the object: "stages[1]".
/// Returns a warning for each option given by its former name.
/// - Messages read "stages[1] find_mountain_tops has no option 'x'", "stages[1].min_prominence must be a
///   number".
/// - Throws Error{usage}; some options of `step` may then be set already.
[[nodiscard]] std::vector<std::string> read_options(Step& step, std::string_view json_object,
                                                    std::string_view location);

/// Sets one option from command-line text: "25", "true", "ocean". A list is given as JSON or as its single
/// entry. Returns a warning if the option is given by its former name.
[[nodiscard]] std::vector<std::string> set_option(Step& step, std::string_view option, std::string_view text);

/// Checks range and choices of every option, for options set in C++. NaN is out of range. Throws
/// Error{usage}.
void check_options(const Step& step, std::string_view location);

/// Returns the options that affect the result as one line of JSON, sorted by name. Equal text means equal
/// results.
std::string canonical_options(const Step& step);

}  // namespace waymark::pipeline
