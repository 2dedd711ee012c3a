// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "apps/command.hpp"
namespace waymark {

/// Reads the options at the head of `words` and returns the words from the first that is none of them.
std::vector<std::string> parse_leading(std::span<const Argument> options,
                                       const std::vector<std::string>& words);

/// Reads all words of the command `name` into the targets of its arguments.
/// Throws Error{usage}: unknown option (with the nearest name), a word too many, a value that is no number or
/// none of the choices.
void parse(const std::string& name, std::span<const Argument> arguments,
           const std::vector<std::string>& words);

/// Throws Error{usage} naming the first required argument that has no value.
void require(const std::string& name, std::span<const Argument> arguments);

/// A finite number that fills the whole word; throws Error{usage}: "<what> must be a number, is 'ten'".
double to_number(const std::string& what, const std::string& word);

/// How an argument stands in a synopsis: "MAP.gpkg", "-o MAP.gpkg", "[--type T]...".
std::string synopsis(const Argument& argument);

/// Its long name, or its short one, or the placeholder of a positional word.
std::string display_name(const Argument& argument);

}  // namespace waymark
