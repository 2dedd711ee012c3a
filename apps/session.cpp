// SPDX-License-Identifier: Apache-2.0
#include "apps/session.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <fmt/chrono.h>

#include "apps/log.hpp"
#include "core/error.hpp"
#include "core/source_date.hpp"
#include "workflows/file_access.hpp"

namespace waymark::apps {
namespace {

std::string quoted(const std::string& word) {
  constexpr auto plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./%@";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) c == '\'' ? text += "'\\''" : text += c;
  return text + "'";
}

/// Receives what GDAL reports outside of every listener, as from its threads. Our own message says what
/// failed and in which file; GDAL's line is a detail.
void log_gdal(CPLErr level, CPLErrorNum number, const char* text) {
  if (level == CE_Debug) return CPLDefaultErrorHandler(level, number, text);
  if (level == CE_Fatal) return log_error(std::string("GDAL: ") + text);
  log_detail(std::string("GDAL: ") + text);
}

}  // namespace

std::vector<Argument> global_arguments(Session& session) {
  return {
      {"-h,--help", "", &session.help, "Show what a command does, its options and examples"},
      {"-V,--version", "", &session.version,
       "Show the version, how the program was built and with which libraries; "
       "with --format json for a program"},
      {"-q,--quiet", "", &session.quiet, "Print errors only"},
      {"-v,--verbose", "", &session.verbose, "Print more: every input file with its SHA-256"},
      Argument{"--threads", "N", &session.threads, "Threads to compute with"}.or_else("one per processor"),
      Argument{"--progress", "HOW", &session.progress,
               "Show progress on standard error; auto is a bar on a terminal and a line now and then "
               "elsewhere, dots are GDAL's"}
          .one_of({"auto", "bar", "dots", "json", "none"})
          .or_else("auto"),
      {"--config", "KEY=VALUE", &session.gdal_config, "Set a configuration option of GDAL; may be repeated"},
      Argument{"--plugin", "FILE.so", &session.plug_ins,
               "Load landmark types, stages and detectors of a plug-in; may be repeated"}
          .offering(Offer::file),
      {"--allow-network", "", &session.allow_network,
       "Permit files to name files on the network; an address on the command line permits it, too"},
  };
}

std::vector<std::string> named_plug_ins(const std::vector<std::string>& words) {
  constexpr std::string_view kOption = "--plugin";
  std::vector<std::string> files;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == kOption && i + 1 < words.size())
      files.push_back(words[++i]);
    else if (words[i].starts_with(std::string(kOption) + "="))
      files.push_back(words[i].substr(kOption.size() + 1));
  }
  return files;
}

void begin(const Session& session) {
  CPLSetErrorHandler(log_gdal);
  if (!session.allow_network && !session.names_network) workflows::refuse_network();
  set_log_level(session.quiet ? LogLevel::errors : session.verbose ? LogLevel::all : LogLevel::warnings);
  if (session.threads < 0)
    throw Error(ErrorCode::usage, "--threads must be 1 or more, or 0 for one per processor, is " +
                                      std::to_string(session.threads));
  if (const auto fixed = source_date())  // the time that GDAL writes into files
    CPLSetConfigOption("OGR_CURRENT_DATE", fmt::format("{:%FT%T}.000Z", *fixed).c_str());
  for (const std::string& setting : session.gdal_config) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(ErrorCode::usage, "--config takes KEY=VALUE, is '" + setting + "'", "",
                  "e.g. --config GDAL_CACHEMAX=512");
    CPLSetConfigOption(setting.substr(0, equals).c_str(), setting.substr(equals + 1).c_str());
  }
}

std::string quoted(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + quoted(word);
  return line;
}

}  // namespace waymark::apps
