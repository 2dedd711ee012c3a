// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark {

/// The style sheet of a report: light, dark and print.
extern const std::string_view kPageStyle;

}  // namespace waymark
