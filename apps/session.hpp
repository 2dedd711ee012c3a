// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/command.hpp"
namespace waymark::apps {

/// Global options and the command line.
struct Session {
  std::string command_line;  ///< as typed, quoted so that a shell reads it back
  std::int64_t threads = 0;  ///< 0: one per processor
  std::string progress = "auto";
  std::vector<std::string> gdal_config;  ///< KEY=VALUE
  std::vector<std::string> plug_ins;     ///< shared libraries
  bool allow_network = false;
  bool names_network = false;  ///< a word of the command line does
  bool quiet = false, verbose = false;
  bool help = false, version = false;
};

/// Returns the global options, allowed before and after the command.
std::vector<Argument> global_arguments(Session& session);

/// Returns the plug-ins that a command line names: commands are declared with what they add.
std::vector<std::string> named_plug_ins(const std::vector<std::string>& words);

/// Sets the level of the log and GDAL's options. Throws Error{usage} for a bad --threads or --config.
void begin(const Session& session);

/// Joins the words of a command line; words with spaces or signs of the shell are quoted.
std::string quoted(const std::vector<std::string>& words);

}  // namespace waymark::apps
