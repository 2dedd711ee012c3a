// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark {

/// Text for people, on standard error.
enum class LogLevel { errors, warnings, all };

void set_log_level(LogLevel level);
bool quiet_log();  ///< true under LogLevel::errors: summaries are left out too

void log_error(std::string_view text);
void log_warning(std::string_view text);
void log_detail(std::string_view text);

/// Written as it is, unless the log is quiet: summaries and what was made.
void say(std::string_view text);

}  // namespace waymark
