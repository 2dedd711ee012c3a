// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/lower_case.hpp"

namespace waymark::importers {
namespace {

constexpr std::array kTextEndings = {".csv",    ".tsv",    ".txt",    ".dat",   ".tab",
                                     ".csv.gz", ".tsv.gz", ".txt.gz", ".dat.gz"};

bool named_like_text(std::string_view path) {
  const std::string name = lower_case(path);
  return std::ranges::any_of(kTextEndings, [&](const char* ending) { return name.ends_with(ending); });
}

}  // namespace

std::string TableSource::row_location(const TableRow& row) const {
  return fmt::format("{}, {} {}", header().path, header().row_word, row.number);
}

std::unique_ptr<TableSource> open_table(const std::string& path, TableFormat format, const std::string& layer,
                                        const std::string& type) {
  const bool text = format == TableFormat::csv || (format == TableFormat::by_name && named_like_text(path));
  return text ? open_csv_table(path) : open_ogr_table(path, layer, type);
}

}  // namespace waymark::importers
