// SPDX-License-Identifier: Apache-2.0
#include "geodb/checks/map_checks.hpp"

#include <fmt/format.h>

namespace waymark::geodb {
namespace {

constexpr std::int64_t kMaxPerKind = 100;

}  // namespace

void FindingList::add(std::string code, std::string table, std::optional<std::int64_t> row,
                      std::string text) {
  if (++count_[{code, table}] <= kMaxPerKind)
    findings_.push_back({std::move(code), std::move(table), row, std::move(text)});
}

std::vector<Finding> FindingList::take() {
  for (const auto& [kind, count] : count_)
    if (count > kMaxPerKind)
      findings_.push_back(
          {kind.first, kind.second, std::nullopt, fmt::format("and {} more of these", count - kMaxPerKind)});
  return std::move(findings_);
}

}  // namespace waymark::geodb
