// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>
#include "core/options/option_table.hpp"
namespace waymark::inline core {

/// Receives the warnings about an object's options, one sentence each. An empty function is not called.
using OptionWarning = std::function<void(const std::string&)>;

/// Names of the options' owner in messages, and of what else its object may hold.
struct OptionLocation {
  std::string owner;                   ///< "stages[1] find_mountain_tops", in "... has no option 'x'"
  std::string prefix = {};             ///< "stages[1].", in front of an option's name
  std::string where = {};              ///< file or argument; empty: the caller adds it
  std::vector<std::string> also = {};  ///< other keys that the object may have
};

/// Sets options from a JSON object, and checks range and choices of those it sets. Returns a warning for each
/// option that is given by its former name. Throws Error{usage}, which names the location, the nearest name
/// and the option's effect; some options may be set already.
[[nodiscard]] std::vector<std::string> read_options(const DescribeOptions& describe,
                                                    std::string_view json_object,
                                                    const OptionLocation& location);

/// Reads options and passes the warnings on.
void read_and_warn(const DescribeOptions& describe, std::string_view json_object,
                   const OptionLocation& location, const OptionWarning& warn);

/// Sets one option from command-line text: "25", "true", "ocean". A list is given as JSON or as its single
/// entry. Returns and throws as read_options does.
[[nodiscard]] std::vector<std::string> set_option(const DescribeOptions& describe, std::string_view option,
                                                  std::string_view text, const OptionLocation& location);

/// Checks range and choices of every option, for options set in C++. NaN is out of range. Throws
/// Error{usage}.
void check_options(const DescribeOptions& describe, const OptionLocation& location);

/// Checks a number that no option declares, such as one of a command line, by the same message. Throws
/// Error{usage}.
void check_number(const std::string& name, double number, const std::string& unit, const Field& field);

}  // namespace waymark::inline core
