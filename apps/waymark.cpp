// SPDX-License-Identifier: Apache-2.0
#include <tbb/global_control.h>

#include <iostream>
#include <new>
#include <optional>

#include "apps/command.hpp"
#include "apps/help.hpp"
#include "apps/interrupt.hpp"
#include "apps/log.hpp"
#include "apps/parse.hpp"
#include "apps/session.hpp"
#include "apps/version.hpp"
#include "core/error.hpp"
#include "workflows/file_access.hpp"
#include "workflows/plug_in.hpp"
#include "workflows/provenance.hpp"

namespace waymark::apps {
namespace {

/// Parses the words after the command's name; global options may stand there too.
int run_command(const CommandTable& commands, Session& session, const std::vector<std::string>& words) {
  Command& command = commands.find(words[0]);
  const CommandSpec spec = command.describe();
  const std::vector<Argument> globals = global_arguments(session);
  std::vector<Argument> arguments = spec.arguments;
  arguments.insert(arguments.end(), globals.begin(), globals.end());
  const std::vector<std::string> warnings = parse(spec.name, arguments, {words.begin() + 1, words.end()});
  if (session.help) {
    std::cout << command_help(spec, globals);
    return 0;
  }
  require(spec.name, arguments);
  begin(session);
  for (const std::string& warning : warnings) log_warning(warning);
  // For libraries below a command that start threads of their own accord, too.
  std::optional<tbb::global_control> at_most;
  if (session.threads > 0)
    at_most.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(session.threads));
  return command.run(session);
}

int run_program(const std::vector<std::string>& words) {
  Session session;
  session.command_line = quoted(words);
  session.names_network = workflows::names_network(words);
  for (const std::string& file : named_plug_ins(words)) workflows::load_plug_in(file);
  CommandTable commands;
  register_commands(commands);
  const std::vector<Argument> globals = global_arguments(session);
  std::vector<Argument> leading = globals;
  std::string version_format;
  if (words.size() > 1 && (words[1] == "-V" || words[1] == "--version"))
    leading.push_back(format_option(&version_format));
  const std::vector<std::string> rest = parse_leading(leading, {words.begin() + 1, words.end()});
  if (session.version) {
    std::cout << (version_format == "json" ? version_as_json() : version_as_text());
    return 0;
  }
  if (rest.empty()) {
    (session.help ? std::cout : std::cerr) << program_help(commands.describe(), globals);
    return session.help ? 0 : 2;
  }
  return run_command(commands, session, rest);
}

/// The one place where errors become text and exit codes.
int guarded(const std::vector<std::string>& words) {
  try {
    const int code = run_program(words);
    end_progress();
    if (!std::cout.flush())
      throw Error(ErrorCode::output, "cannot write to standard output", "", "is the disk full?");
    return code;
  } catch (const Error& error) {
    wait_if_interrupted();
    log_error(error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    log_error("out of memory\n  fewer --threads or smaller --tile-cells need less");
  } catch (const std::exception& error) {
    wait_if_interrupted();
    log_error(std::string("this is a fault of waymark itself: ") + error.what());
  }
  return 1;
}

}  // namespace
}  // namespace waymark::apps

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  waymark::apps::watch_interrupts();
  std::vector<std::string> words(argv, argv + argc);
  words[0] = "waymark";
  return waymark::apps::guarded(words);
}
