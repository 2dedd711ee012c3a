// SPDX-License-Identifier: Apache-2.0
#include "apps/console.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/log.hpp"
#include "apps/session.hpp"
#include "pipeline/engine/runner.hpp"

namespace waymark::apps {
namespace {

using Clock = std::chrono::steady_clock;

double fraction(const pipeline::Progress& progress) {
  return progress.total > 0 ? std::clamp(progress.done / static_cast<double>(progress.total), 0.0, 1.0) : 1.0;
}

bool finished(const pipeline::Progress& progress) {
  return !(progress.done < static_cast<double>(progress.total));
}

/// Returns seconds until the stage is done at its present rate; negative if not known yet.
double seconds_left(const pipeline::Progress& progress) {
  if (!(progress.rate > 0)) return -1;
  return std::max(0.0, static_cast<double>(progress.total) - progress.done) / progress.rate;
}

/// Returns "0:07" or "1:02:09"; "-:--" for a negative time.
std::string clock_time(double seconds) {
  if (!(seconds >= 0) || seconds > 1e8) return "-:--";
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

/// Returns "0.31", "3.1", "3100" or "2300000 units/s".
std::string speed(const pipeline::Progress& progress) {
  return progress.rate < 100 ? fmt::format("{:.2g} units/s", progress.rate)
                             : fmt::format("{:.0f} units/s", progress.rate);
}

std::size_t terminal_width() {
  winsize size{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

/// "join_mountain_tops     [#######.......]  50 %  3.1 units/s  0:04 left", redrawn in place. The bar takes
/// the columns that the text leaves.
void draw_bar(const pipeline::Progress& progress) {
  constexpr std::size_t kMinBar = 8, kMaxBar = 24;
  const double part = fraction(progress);
  std::string text = fmt::format(" {:3.0f} %", std::floor(100 * part));
  if (progress.rate > 0 && progress.total > 1) text += "  " + speed(progress);
  if (!finished(progress)) text += "  " + clock_time(seconds_left(progress)) + " left";
  std::string line = fmt::format("{:<22} ", progress.stage);
  const std::size_t width = terminal_width() - 1;  // a full line would wrap
  const std::size_t taken = line.size() + text.size() + 2;
  const std::size_t bar = std::clamp(width - std::min(width, taken), kMinBar, kMaxBar);
  const auto full = static_cast<std::size_t>(part * static_cast<double>(bar));
  line += "[" + std::string(full, '#') + std::string(bar - full, '.') + "]" + text;
  line.resize(std::min(line.size(), width));
  draw_progress("\r" + line + "\x1b[K", finished(progress));
}

/// GDAL's "0...10...20...30...40...50...60...70...80...90...100 - done.", a line per stage.
class Dots {
 public:
  void operator()(const pipeline::Progress& progress) {
    if (progress.stage != stage_) {
      stage_ = progress.stage;
      drawn_ = -1;
      end_progress();
      draw_progress(stage_ + ": ", false);
    }
    const int reached = static_cast<int>(std::floor(fraction(progress) * kSteps));
    std::string text;
    while (drawn_ < reached) {
      ++drawn_;
      text += drawn_ % 4 == 0 ? std::to_string(drawn_ / 4 * 10) : ".";
    }
    draw_progress(finished(progress) ? text + " - done." : text, finished(progress));
  }

 private:
  static constexpr int kSteps = 40;
  std::string stage_;
  int drawn_ = -1;
};

void print_json(const pipeline::Progress& progress) {
  nlohmann::ordered_json line{{"stage", progress.stage},
                              {"done", progress.done},
                              {"total", progress.total},
                              {"units_per_second", progress.rate}};
  if (const double left = seconds_left(progress); left >= 0) line["seconds_left"] = left;
  fmt::print(stderr, "{}\n", line.dump());
}

/// Prints a line every half minute, for logs.
class SparseLines {
 public:
  void operator()(const pipeline::Progress& progress) {
    const auto now = Clock::now();
    if (now - last_ < std::chrono::seconds(30)) return;
    last_ = now;
    fmt::print(stderr, "{}: {:.0f} %, {}, {} left\n", progress.stage, 100 * fraction(progress),
               speed(progress), clock_time(seconds_left(progress)));
  }

 private:
  Clock::time_point last_ = Clock::now();
};

/// Drops repeats: the end of a stage may be reported twice.
std::function<void(const pipeline::Progress&)> without_repeats(
    std::function<void(const pipeline::Progress&)> draw) {
  return [draw = std::move(draw), last = pipeline::Progress()](const pipeline::Progress& progress) mutable {
    if (progress.stage == last.stage && !(progress.done > last.done)) return;
    last = progress;
    draw(progress);
  };
}

/// Returns a function that draws progress on standard error as `--progress` says: a bar, GDAL's dots, JSON
/// lines or nothing. `auto` is a bar on a terminal, a line every half minute elsewhere, and nothing with
/// --quiet. Empty if nothing is drawn.
std::function<void(const pipeline::Progress&)> progress_renderer(const Session& session) {
  const bool automatic = session.progress == "auto";
  if (session.progress == "none" || (automatic && session.quiet)) return {};
  if (session.progress == "bar" || (automatic && isatty(STDERR_FILENO))) return without_repeats(draw_bar);
  if (session.progress == "dots") return without_repeats(Dots());
  if (session.progress == "json") return without_repeats(print_json);
  return SparseLines();
}

void write_message(const workflows::Message& message, bool only_json) {
  switch (message.kind) {
    case workflows::MessageKind::detail:
      return log_detail(message.text);
    case workflows::MessageKind::summary:
      return log_summary(message.text);
    case workflows::MessageKind::warning:
      return log_warning(message.text);
    case workflows::MessageKind::failure:  // a quiet log has no summary that lists it
      if (quiet_log()) log_error(message.text);
      return;
    case workflows::MessageKind::result:
      if (only_json) return log_summary(message.text);
      end_progress();
      std::cout << message.text;
  }
}

}  // namespace

workflows::Callbacks console_callbacks(const Session& session, std::string_view format) {
  const bool only_json = format == "json";
  return {.progress = progress_renderer(session),
          .message = [only_json](const workflows::Message& message) { write_message(message, only_json); }};
}

}  // namespace waymark::apps
