// SPDX-License-Identifier: Apache-2.0
#include "apps/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "core/printable.hpp"

namespace waymark::apps {
namespace {

constexpr std::size_t kMaxMessage = 4000;  // bytes: about a screen

std::atomic<bool> has_open_line = false;

spdlog::logger& log() {
  static const auto logger = [] {
    const char* no_colour = std::getenv("NO_COLOR");  // https://no-color.org
    const bool plain = no_colour != nullptr && *no_colour != '\0';
    auto made = std::make_shared<spdlog::logger>(
        "waymark", std::make_shared<spdlog::sinks::stderr_color_sink_mt>(
                       plain ? spdlog::color_mode::never : spdlog::color_mode::automatic));
    made->set_pattern("%^%l:%$ %v");
    made->set_level(spdlog::level::warn);
    return made;
  }();
  return *logger;
}

}  // namespace

void set_log_level(LogLevel level) {
  log().set_level(level == LogLevel::errors     ? spdlog::level::err
                  : level == LogLevel::warnings ? spdlog::level::warn
                                                : spdlog::level::debug);
}

bool quiet_log() {
  return log().level() > spdlog::level::warn;
}

void draw_progress(std::string_view text, bool ends) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  if (ends) std::fputc('\n', stderr);
  std::fflush(stderr);
  has_open_line = !ends;
}

void end_progress() {
  if (has_open_line.exchange(false)) std::fputc('\n', stderr);
}

void log_error(std::string_view text) {
  end_progress();
  log().error(printable(text, kMaxMessage));
}
void log_warning(std::string_view text) {
  if (!quiet_log()) end_progress();
  log().warn(printable(text, kMaxMessage));
}
void log_detail(std::string_view text) {
  if (log().should_log(spdlog::level::debug)) end_progress();
  log().debug(printable(text));
}

void log_summary(std::string_view text) {
  if (quiet_log()) return;
  end_progress();
  const std::string safe = printable(text);
  std::fwrite(safe.data(), 1, safe.size(), stderr);
}

}  // namespace waymark::apps
