// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/count_rows.hpp"

#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

namespace waymark::exporters {
namespace {

/// What stands for a landmark in the text of a format.
struct TextFormat {
  std::string_view driver;
  std::string_view row, table;  ///< beginnings of elements; each table has a row of column names; empty: none
  std::string_view ending;
  std::string_view member;  ///< file inside the zip file, {} is the number of the sheet; empty: no zip file
};

constexpr std::array kFormats = {
    TextFormat{"KML", "<Placemark", "", "</kml>", ""},
    TextFormat{"ODS", "<table:table-row", "<table:table ", "</office:document-content>", "content.xml"},
    TextFormat{"XLSX", "<row", "<sheetData>", "</worksheet>", "xl/worksheets/sheet{}.xml"}};

const TextFormat* find_format(const std::string& driver) {
  const auto found = std::ranges::find(kFormats, driver, &TextFormat::driver);
  return found == kFormats.end() ? nullptr : &*found;
}

struct CloseFile {
  void operator()(VSILFILE* file) const { VSIFCloseL(file); }
};
using File = std::unique_ptr<VSILFILE, CloseFile>;

File open_member(const TextFormat& format, const std::string& path, int sheet) {
  const std::string member = fmt::format(fmt::runtime(format.member), sheet);
  return File(VSIFOpenL((member.empty() ? path : "/vsizip/{" + path + "}/" + member).c_str(), "rb"));
}

/// Occurrences of `word` that end behind the first `before` bytes.
std::int64_t count_new(std::string_view text, std::string_view word, std::size_t before) {
  if (word.empty()) return 0;
  std::int64_t count = 0;
  std::size_t at = before - std::min(before, word.size() - 1);
  for (; (at = text.find(word, at)) != std::string_view::npos; at += word.size()) ++count;
  return count;
}

std::optional<std::int64_t> count_in(VSILFILE& file, const TextFormat& format) {
  constexpr std::size_t kPiece = 1 << 20, kKept = 64;  // more than the longest word
  std::string text, piece(kPiece, '\0');
  std::int64_t rows = 0;
  while (const std::size_t read = VSIFReadL(piece.data(), 1, kPiece, &file)) {
    const std::size_t before = text.size();
    text.append(piece, 0, read);
    rows += count_new(text, format.row, before) - count_new(text, format.table, before);
    text.erase(0, text.size() - std::min(text.size(), kKept));
  }
  return text.find(format.ending) == std::string::npos ? std::nullopt : std::optional(rows);
}

}  // namespace

bool has_rows_of_text(const std::string& driver) {
  return find_format(driver) != nullptr;
}

std::optional<std::int64_t> count_rows(const std::string& driver, const std::string& path) {
  const TextFormat& format = *find_format(driver);
  const bool has_sheets = format.member.find("{}") != std::string_view::npos;
  std::int64_t rows = 0;
  for (int sheet = 1;; ++sheet) {
    const File file = open_member(format, path, sheet);
    if (!file && sheet > 1) return rows;
    const auto found = file ? count_in(*file, format) : std::nullopt;
    if (!found) return std::nullopt;
    rows += *found;
    if (!has_sheets) return rows;
  }
}

}  // namespace waymark::exporters
