// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
namespace waymark::apps {

// Text for people, on standard error.
enum class LogLevel { errors, warnings, all };

void set_log_level(LogLevel level);
/// Returns true under LogLevel::errors, which suppresses summaries as well.
bool quiet_log();

/// Draws a part of a line of progress, which stays open until `ends`. Messages begin on a line of their own.
void draw_progress(std::string_view text, bool ends);
/// Ends a line of progress that is open.
void end_progress();

void log_error(std::string_view text);
void log_warning(std::string_view text);
void log_detail(std::string_view text);

/// Writes a summary as it is, unless the log is quiet.
void log_summary(std::string_view text);

}  // namespace waymark::apps
