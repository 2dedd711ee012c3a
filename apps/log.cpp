// SPDX-License-Identifier: Apache-2.0
#include "apps/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <cstdlib>

#include "core/printable.hpp"

namespace waymark::apps {
namespace {

constexpr std::size_t kMaxMessage = 4000;  // bytes: about a screen

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

void log_error(std::string_view text) {
  log().error(printable(text, kMaxMessage));
}
void log_warning(std::string_view text) {
  log().warn(printable(text, kMaxMessage));
}
void log_detail(std::string_view text) {
  log().debug(printable(text));
}

void log_summary(std::string_view text) {
  if (quiet_log()) return;
  const std::string safe = printable(text);
  std::fwrite(safe.data(), 1, safe.size(), stderr);
}

}  // namespace waymark::apps
