// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <span>
#include <sstream>
#include <string>

#include "apps/command.hpp"
#include "apps/help.hpp"
#include "apps/parse.hpp"
#include "apps/session.hpp"
#include "workflows/provenance.hpp"

namespace waymark::apps {
namespace {

// Escapes text so that roff prints it literally, with hyphens that can be copied.
std::string plain(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else if ((c == '.' || c == '\'') && (safe.empty() || safe.back() == '\n'))
      safe += std::string("\\&") + c;
    else
      safe += c;
  }
  return safe;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string paragraphs(const std::string& text) {
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) result += line.empty() ? ".PP\n" : plain(line) + "\n";
  return result;
}

std::string entry(const Argument& argument) {
  if (argument.positional())
    return ".TP\n" + italic(argument.value) + "\n" + plain(full_help(argument)) + ".\n";
  std::string names, name;
  std::istringstream all(argument.names);
  while (std::getline(all, name, ',')) names += (names.empty() ? "" : ", ") + bold(name);
  return ".TP\n" + names + (argument.flag() ? "" : " " + italic(argument.value)) + "\n" +
         plain(full_help(argument)) + ".\n";
}

std::string section(const CommandSpec& command) {
  std::string usage;
  for (const Argument& argument : command.arguments) usage += " " + plain(synopsis(argument));
  std::string text = ".SS " + plain(command.name) + "\n.B waymark " + plain(command.name) + "\n" +
                     (usage.empty() ? "" : usage.substr(1) + "\n") + ".PP\n" + plain(command.summary) + ".\n";
  if (!command.about.empty()) text += ".PP\n" + paragraphs(command.about);
  for (const Argument& argument : command.arguments) text += entry(argument);
  if (!command.result.empty()) text += ".PP\nKeys of " + plain(command.result_option) + " json:\n";
  for (const ResultKey& key : command.result)
    text += ".TP\n" + bold(key.name) + "\n" + plain(key.meaning) + ".\n";
  for (const Example& example : command.examples)
    text +=
        ".PP\n" + plain(example.says) + ":\n.PP\n.nf\n.RS\n" + plain(example.command_line) + "\n.RE\n.fi\n";
  return text;
}

// Returns waymark(1) as roff, all commands on one page.
std::string man_page(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  std::string text = ".TH WAYMARK 1 \"\" \"" + workflows::program_version() +
                     "\" \"User commands\"\n.SH NAME\nwaymark \\- semantic navigation maps from elevation "
                     "models, images and laser data\n"
                     ".SH SYNOPSIS\n.B waymark\n.I COMMAND\n[arguments and options]\n.SH COMMANDS\n";
  for (const CommandSpec& command : commands) text += section(command);
  text += ".SH OPTIONS OF EVERY COMMAND\n";
  for (const Argument& argument : globals) text += entry(argument);
  text += ".SH EXIT STATUS\n";
  for (const ExitCode& exit : exit_codes())
    text += ".TP\n" + bold(std::to_string(exit.code)) + "\n" + plain(exit.says) + ".\n";
  return text;
}

class Man final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "man",
            .group = Group::look_up,
            .summary = "Print the manual page",
            .examples = {{"waymark man | man -l -", "Read it"},
                         {"waymark man > ~/.local/share/man/man1/waymark.1", "Keep it where man finds it"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    std::cout << man_page(commands.describe(), global_arguments(any));
    return 0;
  }
};

}  // namespace

void register_command_man(CommandTable& commands);
void register_command_man(CommandTable& commands) {
  commands.add<Man>();
}

}  // namespace waymark::apps
