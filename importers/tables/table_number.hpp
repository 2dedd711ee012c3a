// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string_view>
namespace waymark::importers {

/// Returns whether a cell has no value: empty, NA, N/A, NaN, null, none, - or --, in any case.
bool is_missing(std::string_view cell);

/// Parses a finite number that fills the whole cell except for blanks around it. `decimal_comma` allows 3,5
/// beside 3.5. `std::nullopt` for other text.
std::optional<double> to_real(std::string_view cell, bool decimal_comma);

}  // namespace waymark::importers
