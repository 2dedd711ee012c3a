// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "testbed/score.hpp"
namespace waymark {

/// Scores by landmark type, for people and for programs. Numbers that do not exist are "-" and null.
std::string scores_as_text(const std::map<std::string, Score>& scores);
std::string scores_as_json(const std::map<std::string, Score>& scores);

}  // namespace waymark
