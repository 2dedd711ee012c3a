// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "apps/shell_completion.hpp"

namespace waymark::apps {
namespace {

std::string fish_text(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe + "'";
}

// Returns what follows the name of an argument that takes a value.
std::string fish_values(const Argument& argument) {
  const auto& words = argument.choices.empty() ? argument.suggestions : argument.choices;
  if (!words.empty()) return " -xa " + fish_text(fmt::format("{}", fmt::join(words, " ")));
  if (argument.offer == Offer::file) return " -rF";
  return argument.offer == Offer::folder ? " -xa '(__fish_complete_directories)'" : " -x";
}

std::string fish_option(const Argument& argument, const std::string& condition) {
  std::string text = "complete -c waymark" + condition;
  std::istringstream names(argument.names);
  for (std::string name; std::getline(names, name, ',');)
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  text += " -d " + fish_text(argument.help);
  return text + (argument.flag() ? "" : fish_values(argument)) + "\n";
}

std::string fish_words(const Argument& argument, const std::string& condition) {
  const auto& words = argument.choices.empty() ? argument.suggestions : argument.choices;
  if (!words.empty())
    return "complete -c waymark" + condition + " -a " + fish_text(fmt::format("{}", fmt::join(words, " "))) +
           "\n";
  return argument.offer == Offer::nothing ? "" : "complete -c waymark" + condition + " -F\n";
}

// Functions that find the command behind options: fish's own take `2` of `--threads 2` for it.
std::string fish_functions(std::span<const Argument> globals) {
  std::string with_values;
  for (const Argument& argument : globals) {
    if (argument.flag()) continue;
    std::istringstream names(argument.names);
    for (std::string name; std::getline(names, name, ',');) with_values += " " + name;
  }
  return R"(function __waymark_command
    set -l words (commandline -poc)
    set -e words[1]
    while set -q words[1]
        switch $words[1]
            case)" +
         with_values + R"(
                set -e words[1]
                set -q words[1]; and set -e words[1]
            case '-*'
                set -e words[1]
            case '*'
                echo $words[1]
                return
        end
    end
end
function __waymark_has_no_command
    not count (__waymark_command) >/dev/null
end
function __waymark_command_is
    contains -- $argv[1] (__waymark_command)
end
)";
}

}  // namespace

std::string fish_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  std::string text = "# fish completion for waymark, written by `waymark completion fish`\n" +
                     fish_functions(globals) + "complete -c waymark -f\n";
  for (const Argument& argument : globals) text += fish_option(argument, "");
  for (const CommandSpec& command : commands)
    text += "complete -c waymark -n __waymark_has_no_command -a " + command.name + " -d " +
            fish_text(command.summary) + "\n";
  for (const CommandSpec& command : commands) {
    const std::string condition = " -n '__waymark_command_is " + command.name + "'";
    for (const Argument& argument : command.arguments)
      text += argument.positional() ? fish_words(argument, condition) : fish_option(argument, condition);
  }
  return text;
}

}  // namespace waymark::apps
