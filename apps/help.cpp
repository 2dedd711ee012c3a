// SPDX-License-Identifier: Apache-2.0
#include "apps/help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <sstream>
#include <string_view>

#include "apps/parse.hpp"
#include "apps/session.hpp"
#include "workflows/provenance.hpp"

namespace waymark::apps {
namespace {

constexpr std::size_t kMaxWidth = 100, kMinWidth = 60, kTextColumn = 26;

/// Returns the columns for text: the environment's COLUMNS, else those of the terminal. In `waymark --help |
/// less` only standard error is one.
std::size_t width() {
  std::size_t columns = 0;
  if (const char* asked = std::getenv("COLUMNS")) {
    const std::string_view digits(asked);
    std::from_chars(digits.data(), digits.data() + digits.size(), columns);
  }
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) {
    winsize size{};
    if (columns == 0 && ioctl(file, TIOCGWINSZ, &size) == 0) columns = size.ws_col;
  }
  return columns > 0 ? std::clamp(columns, kMinWidth, kMaxWidth) : kMaxWidth;
}

/// Wraps paragraphs at the width of the terminal and indents every line by `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent) {
  const std::size_t columns = width();
  std::string result, line;
  const auto flush = [&] {
    if (!line.empty()) result += std::string(indent, ' ') + line + "\n";
    line.clear();
  };
  std::istringstream paragraphs(text);
  for (std::string paragraph; std::getline(paragraphs, paragraph); flush()) {
    if (paragraph.empty()) result += "\n";
    std::istringstream words(paragraph);
    for (std::string word; words >> word; line += (line.empty() ? "" : " ") + word)
      if (indent + line.size() + 1 + word.size() > columns) flush();
  }
  return result;
}

/// Returns a name with its explanation beside it, or below a long name.
std::string entry(const std::string& name, const std::string& text) {
  const std::string left = "  " + name;
  std::string right = wrapped(text, kTextColumn);
  if (left.size() + 2 > kTextColumn) return left + "\n" + right;
  return left + right.substr(left.size());
}

std::string entry(const Argument& argument) {
  std::string left = argument.positional() ? argument.value : argument.names;
  if (const auto comma = left.find(','); !argument.positional() && comma != std::string::npos)
    left.insert(comma + 1, " ");
  if (!argument.positional() && !argument.flag()) left += " " + argument.value;
  return entry(left, full_help(argument));
}

std::string section(const std::string& title, std::span<const Argument> arguments, bool positional) {
  std::string text;
  for (const Argument& argument : arguments)
    if (argument.positional() == positional) text += entry(argument);
  return text.empty() ? "" : "\n" + title + ":\n" + text;
}

std::string usage(const CommandSpec& command) {
  std::string line = "waymark " + command.name;
  for (const Argument& argument : command.arguments)
    if (argument.positional() || argument.required) line += " " + synopsis(argument);
  return "Usage: " + line + " [options]\n";
}

std::string heading(Group group) {
  switch (group) {
    case Group::make:
      return "Make a map";
    case Group::use:
      return "Use a map";
    case Group::look_up:
      return "Look up";
  }
  return "";
}

}  // namespace

std::string full_help(const Argument& argument) {
  std::string text = argument.help;
  if (!argument.choices.empty()) text += fmt::format(": {}", fmt::join(argument.choices, ", "));
  if (takes_list(argument)) text += "; @FILE for those that a text file lists";
  if (!argument.otherwise.empty()) text += " (default: " + argument.otherwise + ")";
  if (!argument.former.empty()) text += " (formerly " + argument.former + ")";
  return text;
}

std::vector<ExitCode> exit_codes() {
  return {{0, "Done"},
          {1, "The run failed, or `validate` found faults"},
          {2, "Wrong usage, a bad option or a bad job file"},
          {3, "Finished, but some units of work failed; with --work a second run does only those"}};
}

std::string command_help(const CommandSpec& command, std::span<const Argument> globals) {
  std::string text = usage(command) + "\n" + wrapped(command.summary + ".", 0);
  if (!command.about.empty()) text += "\n" + wrapped(command.about, 0);
  text += section("Arguments", command.arguments, true) + section("Options", command.arguments, false);
  text += section("Options of every command", globals, false);
  if (!command.result.empty()) text += "\nKeys of " + command.result_option + " json:\n";
  for (const ResultKey& key : command.result) text += entry(key.name, key.meaning);
  if (!command.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : command.examples)
    text += "  " + example.command_line + "\n" + wrapped(example.says, 6);
  return text;
}

std::string program_help(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  std::string text = workflows::program_version() +
                     ": semantic navigation maps from elevation models, images and laser data\n\n"
                     "Usage: waymark COMMAND [arguments and options]\n";
  for (const Group group : {Group::make, Group::use, Group::look_up}) {
    text += "\n" + heading(group) + ":\n";
    for (const CommandSpec& command : commands)
      if (command.group == group) text += entry(command.name, command.summary);
  }
  text += section("Options of every command", globals, false) + "\nExit codes:\n";
  for (const ExitCode& exit : exit_codes()) text += entry(std::to_string(exit.code), exit.says);
  return text + "\n`waymark COMMAND --help` explains a command and shows examples.\n";
}

}  // namespace waymark::apps
