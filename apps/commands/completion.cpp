// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <span>
#include <string>

#include "apps/command.hpp"
#include "apps/session.hpp"
#include "apps/shell_completion.hpp"

namespace waymark::apps {
namespace {

constexpr auto kHead = R"(# bash completion for waymark, written by `waymark completion bash`
_waymark() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command= word words= path=
  [[ $cur == = ]] && cur=
  [[ $prev == = ]] && prev=${COMP_WORDS[COMP_CWORD-2]}
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
)";

constexpr auto kTail = R"(  esac
  local offered=()
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  if [[ -n $path ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t offered < <(compgen -A "$path" -- "$cur")
    COMPREPLY+=("${offered[@]}")
  fi
}
complete -F _waymark waymark
)";

// Returns assignments that make the script offer values for these arguments.
std::string offer(std::span<const Argument> arguments) {
  std::vector<std::string> words;
  std::string path;
  for (const Argument& argument : arguments) {
    const auto& more = argument.choices.empty() ? argument.suggestions : argument.choices;
    words.insert(words.end(), more.begin(), more.end());
    if (argument.offer != Offer::nothing)
      path = argument.offer == Offer::file ? " path=file" : " path=directory";
  }
  return fmt::format("words='{}'{}", fmt::join(words, " "), path);
}

std::string alternatives(std::string names) {
  std::ranges::replace(names, ',', '|');
  return names;
}

std::string options(std::span<const Argument> arguments) {
  std::string all;
  for (const Argument& argument : arguments) all += (all.empty() ? "" : " ") + argument.names;
  std::ranges::replace(all, ',', ' ');
  return all;
}

// Returns branches on the previous word: the value of an option, else options or positional words.
std::string branches(std::span<const Argument> arguments) {
  std::string text;
  std::vector<Argument> words, named;
  for (const Argument& argument : arguments) (argument.positional() ? words : named).push_back(argument);
  for (const Argument& argument : named)
    if (!argument.flag())
      text += "      " + alternatives(argument.names) + ") " + offer(std::span(&argument, 1)) + " ;;\n";
  text +=
      "      *) if [[ $cur == -* ]]; then words='" + options(named) + "'; else " + offer(words) + "; fi ;;\n";
  return "case $prev in\n" + text + "    esac ;;\n";
}

// Returns a bash script that completes commands, options, choices and paths without calling the program.
std::string bash_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  std::vector<std::string> names;
  for (const CommandSpec& command : commands) names.push_back(command.name);
  std::string text = kHead;
  text += fmt::format("    case $word in {}) command=$word; break ;; esac\n  done\n  case $command in\n",
                      fmt::join(names, "|"));
  for (const CommandSpec& command : commands) {
    std::vector<Argument> arguments = command.arguments;
    arguments.insert(arguments.end(), globals.begin(), globals.end());
    text += "    " + command.name + ") " + branches(arguments);
  }
  std::vector<Argument> before(globals.begin(), globals.end());
  before.push_back(Argument{"", "COMMAND", {}, ""}.offering(names));
  return text + "    '') " + branches(before) + kTail;
}

class Completion final : public Command {
 public:
  CommandSpec describe() override {
    return {.name = "completion",
            .group = Group::look_up,
            .summary = "Print a script that completes waymark's command lines in a shell",
            .about = "It completes commands, options, values and file names.",
            .arguments = {Argument{"", "SHELL", &shell_, "Shell to complete in"}.needed().one_of(
                {"bash", "zsh", "fish"})},
            .examples = {
                {"source <(waymark completion bash)", "Completion for this shell"},
                {"waymark completion bash > ~/.local/share/bash-completion/completions/waymark",
                 "Completion for every new shell"},
                {"waymark completion zsh > ~/.zfunc/_waymark", "For zsh; the folder must be in its fpath"},
                {"waymark completion fish > ~/.config/fish/completions/waymark.fish", "For fish"}}};
  }

  int run(const Session&) override {
    CommandTable commands;
    register_commands(commands);
    Session any;
    std::vector<CommandSpec> specs = commands.describe();
    std::vector<std::string> names;
    for (const CommandSpec& spec : specs) names.push_back(spec.name);
    for (CommandSpec& spec : specs)
      if (spec.name == "help") spec.arguments[0] = spec.arguments[0].offering(names);
    const auto script = shell_ == "zsh"    ? zsh_completion
                        : shell_ == "fish" ? fish_completion
                                           : bash_completion;
    std::cout << script(specs, global_arguments(any));
    return 0;
  }

 private:
  std::string shell_;
};

}  // namespace

void register_command_completion(CommandTable& commands);
void register_command_completion(CommandTable& commands) {
  commands.add<Completion>();
}

}  // namespace waymark::apps
