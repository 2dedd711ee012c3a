// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/command.hpp"
namespace waymark {

/// What holds for every command: the global options, and how the program was called.
struct Session {
  std::string command_line;  ///< as typed, quoted so that a shell reads it back
  std::int64_t threads = 0;  ///< 0: one per processor
  std::string progress = "auto";
  std::vector<std::string> gdal_config;  ///< KEY=VALUE
  bool quiet = false, verbose = false;
  bool help = false, version = false;
};

/// The global options, allowed before and after the command.
std::vector<Argument> global_arguments(Session& session);

/// Sets the level of the log and GDAL's options. Throws Error{usage} for a bad --threads or --config.
void begin(const Session& session);

/// Joins the words of a command line; words with spaces or signs of the shell are quoted.
std::string quoted(const std::vector<std::string>& words);

/// "waymark 0.1.0".
std::string program_version();

}  // namespace waymark
