// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include "pipeline/engine/step.hpp"
namespace waymark {

/// Sets options from a JSON object and checks them. `place` is where the object stands, "stages[1]"; messages
/// read "stages[1] find_mountain_tops has no option 'x'" and "stages[1].min_prominence must be a number".
/// Throws Error{usage}; `step` may then be half set.
void read_options(Step& step, std::string_view json_object, std::string_view place);

/// Sets one option from the text of a command line: "25", "true", "ocean"; a list as JSON or as its one
/// entry.
void set_option(Step& step, std::string_view option, std::string_view text);

/// Range and choices of every option, NaN included: for options set in C++.
void check_options(const Step& step, std::string_view place);

}  // namespace waymark
