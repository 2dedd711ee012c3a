// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>
namespace waymark {

/// Empty, or one of the words tables write for no value: NA, N/A, NaN, null, none, - and --, in any case.
bool is_missing(std::string_view cell);

/// A finite number that fills the whole cell, but for blanks around it. `decimal_comma`: 3,5 is allowed
/// beside 3.5.
std::optional<double> to_real(std::string_view cell, bool decimal_comma);

}  // namespace waymark
