// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
namespace waymark::testbed {

/// Returns ranges or depths (metres) as the items of a JSON list: null where there is no return.
std::string ranges_text(std::span<const float> ranges, int decimals);

}  // namespace waymark::testbed
