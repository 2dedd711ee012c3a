// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <iostream>
#include <new>
#include <optional>

#include "apps/command.hpp"
#include "apps/help.hpp"
#include "apps/log.hpp"
#include "apps/parse.hpp"
#include "apps/session.hpp"
#include "core/error.hpp"
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
  CommandTable commands;
  register_commands(commands);
  const std::vector<Argument> globals = global_arguments(session);
  const std::vector<std::string> rest = parse_leading(globals, {words.begin() + 1, words.end()});
  if (session.version) {
    std::cout << workflows::program_version() << '\n';
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
    if (!std::cout.flush())
      throw Error(ErrorCode::output, "cannot write to standard output", "", "is the disk full?");
    return code;
  } catch (const Error& error) {
    log_error(error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    log_error("out of memory\n  fewer --threads or smaller --tile-cells need less");
  } catch (const std::exception& error) {
    log_error(std::string("this is a fault of waymark itself: ") + error.what());
  }
  return 1;
}

/// Reports an interrupted run, and ends as by the default action, so that shells and makefiles see it.
void report_interrupt(int signal) {
  constexpr char text[] =
      "\nerror: interrupted; an output that was not finished is not put in place\n  with --work, the same "
      "command "
      "again continues where it stopped\n";
  static_cast<void>(!::write(STDERR_FILENO, text, sizeof text - 1));
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

}  // namespace
}  // namespace waymark::apps

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  for (const int signal : {SIGINT, SIGTERM}) ::signal(signal, waymark::apps::report_interrupt);
  std::vector<std::string> words(argv, argv + argc);
  words[0] = "waymark";
  return waymark::apps::guarded(words);
}
