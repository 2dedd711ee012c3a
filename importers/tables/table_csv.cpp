// SPDX-License-Identifier: Apache-2.0
#include <cpl_vsi.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/error.hpp"
#include "importers/gdal_session.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;  // bytes that are read together

/// Text of a file, piece by piece.
class TextPieces {
 public:
  explicit TextPieces(const std::string& path) : path_(path) {
    const GdalListener quiet;
    const std::string name = path.ends_with(".gz") && !path.starts_with("/vsi") ? "/vsigzip/" + path : path;
    VSIStatBufL status;
    if (VSIStatL(name.c_str(), &status) != 0)
      throw Error(ErrorCode::input, "there is no such file", path, "check the path");
    if (VSI_ISDIR(status.st_mode))
      throw Error(ErrorCode::input, "this is a folder, not a table", path, "name a file in it");
    file_.reset(VSIFOpenL(name.c_str(), "rb"));
    if (!file_) refuse(quiet);
  }

  /// Appends a piece; false at the end of the file.
  bool append_to(std::string& text) {
    const GdalListener quiet;
    const std::size_t before = text.size();
    text.resize(before + kPiece);
    const std::size_t got = VSIFReadL(text.data() + before, 1, kPiece, file_.get());
    text.resize(before + got);
    if (got < kPiece && !quiet.error_about(path_).empty()) refuse(quiet);
    if (text.find('\0', before) != std::string::npos)
      throw Error(ErrorCode::input, "this is no text table: it holds zero bytes", path_,
                  "pass --from ogr for a vector layer that GDAL reads");
    return got > 0;
  }

 private:
  struct Close {
    void operator()(VSILFILE* file) const { VSIFCloseL(file); }
  };
  [[noreturn]] void refuse(const GdalListener& heard) const {
    throw Error(ErrorCode::input, "the table cannot be read: " + heard.error_about(path_), path_,
                "check its permissions, and fetch it again if it is cut off");
  }

  std::string path_;
  std::unique_ptr<VSILFILE, Close> file_;
};

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

/// Returns the separator of a line: the first of tab, ; | , that it holds outside quotes; else a blank.
char separator_of(std::string_view line) {
  bool quoted = false;
  std::array<int, 256> counts{};
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (!quoted) ++counts[static_cast<unsigned char>(c)];
  }
  for (const char c : {'\t', ';', '|', ','})
    if (counts[static_cast<unsigned char>(c)] > 0) return c;
  return ' ';
}

/// Removes the apostrophe that keeps a spreadsheet from computing a text, as csv_text of the exporters writes
/// it.
std::string without_apostrophe(std::string cell) {
  const bool marked = cell.size() > 1 && cell[0] == '\'' &&
                      std::string_view("=+-@\t\r").find(cell[1]) != std::string_view::npos;
  if (marked) cell.erase(0, 1);
  return cell;
}

class CsvTable final : public TableSource {
 public:
  explicit CsvTable(const std::string& path) : pieces_(path) {
    header_.path = path;
    header_.layer = std::filesystem::path(path).stem().string();
    begin_text();
    read_header();
  }

  const TableHeader& header() const override { return header_; }

  bool next(TableRow& row) override {
    if (first_row_) {
      row = std::move(*first_row_);
      first_row_.reset();
      return true;
    }
    if (!read_whole_row(row)) return false;
    const std::size_t wanted = header_.columns.size();
    if (row.cells.size() == wanted + 1 && row.cells.back().empty()) row.cells.pop_back();
    if (row.cells.size() != wanted)
      throw Error(ErrorCode::input,
                  fmt::format("the row has {} values, the table has {} columns", row.cells.size(), wanted),
                  row_location(row), "quote values that hold the separator, or correct the row");
    return true;
  }

 private:
  /// Reads the first pieces. Refuses only encodings that cannot be read at all: other ones garble names, but
  /// never numbers.
  void begin_text() {
    while (text_.find_first_not_of(" \t\r\n") == std::string::npos && !ended_) {
      ended_ = !pieces_.append_to(text_);
      if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
      if (text_.starts_with("\xFF\xFE") || text_.starts_with("\xFE\xFF"))
        throw Error(ErrorCode::input, "the table is in UTF-16", header_.path,
                    "convert it: iconv -f UTF-16 -t UTF-8 TABLE > utf8.csv");
    }
    if (text_.find_first_not_of(" \t\r\n") == std::string::npos)
      throw Error(ErrorCode::input, "the table is empty", header_.path, "fetch or write it again");
  }

  /// Doubles the text. Returns false if that was all.
  bool read_more() {
    for (const std::size_t wanted = 2 * text_.size() + 1; !ended_ && text_.size() < wanted;)
      ended_ = !pieces_.append_to(text_);
    return !ended_;
  }

  /// Reads a row again with more text while it reaches the end of what was read.
  bool read_whole_row(TableRow& row) {
    for (;;) {
      const std::size_t start = at_;
      const std::int64_t line = line_;
      const bool found = read_row(row);
      if (at_ < text_.size() || ended_) return found;
      text_.erase(0, start);
      at_ = 0, line_ = line;
      read_more();
    }
  }

  void read_header() {
    do {
      at_ = 0, line_ = 1;
      skip_comments();
    } while (text_.find('\n', at_) == std::string::npos && read_more());
    separator_ = separator_of(std::string_view(text_).substr(at_, text_.find('\n', at_) - at_));
    TableRow first;
    if (!read_whole_row(first))
      throw Error(ErrorCode::input, "the table has comments, but no row", header_.path,
                  "fetch or write it again");
    header_.decimal_comma = separator_ != ',';
    const bool named = std::ranges::any_of(first.cells, [&](const std::string& cell) {
      return !is_missing(cell) && !to_real(cell, header_.decimal_comma);
    });
    if (named) {
      while (first.cells.size() > 1 && first.cells.back().empty()) first.cells.pop_back();
      header_.columns = first.cells;
      return;
    }
    for (std::size_t i = 1; i <= first.cells.size(); ++i) header_.columns.push_back(fmt::format("c{}", i));
    first_row_ = std::move(first);
  }

  /// Skips empty lines and comments between rows.
  void skip_comments() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      const std::size_t word = text_.find_first_not_of(" \t\r", at_);
      if (word < end && text_[word] != '#') return;
      at_ = std::min(end + 1, text_.size());
      ++line_;
    }
  }

  bool read_row(TableRow& row) {
    skip_comments();
    if (at_ >= text_.size()) return false;
    row.number = line_;
    row.cells.clear();
    if (separator_ == ' ') skip_blanks();
    do row.cells.push_back(read_cell(row));
    while (!at_end_of_row());
    ++line_;
    return true;
  }

  std::string read_cell(const TableRow& row) {
    while (at_ < text_.size() && is_blank(text_[at_]) && text_[at_] != separator_) ++at_;
    if (at_ < text_.size() && text_[at_] == '"') return read_quoted(row);
    const std::size_t start = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != separator_ &&
           !(separator_ == ' ' && is_blank(text_[at_])))
      ++at_;
    std::size_t end = at_;
    while (end > start && (is_blank(text_[end - 1]) || text_[end - 1] == '\r')) --end;
    return without_apostrophe(text_.substr(start, end - start));
  }

  std::string read_quoted(const TableRow& row) {
    std::string cell;
    for (++at_; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] != '"')
        cell += text_[at_];
      else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"')
        cell += text_[at_++];
      else
        break;
    }
    if (at_ >= text_.size()) {
      if (!ended_) return cell;
      throw Error(ErrorCode::input, "a quote is opened and never closed", row_location(row),
                  "close it, or double the quotes inside a value");
    }
    ++at_;
    while (at_ < text_.size() && text_[at_] != separator_ && text_[at_] != '\n') ++at_;
    return without_apostrophe(std::move(cell));
  }

  void skip_blanks() {
    while (at_ < text_.size() && (is_blank(text_[at_]) || text_[at_] == '\r')) ++at_;
  }

  /// Steps over the separator or the end of the line.
  bool at_end_of_row() {
    if (separator_ == ' ') skip_blanks();
    if (at_ >= text_.size()) return true;
    if (text_[at_] == '\n') return ++at_, true;
    if (separator_ != ' ') ++at_;
    return false;
  }

  TextPieces pieces_;
  std::string text_;    ///< not yet read as rows, but for `at_` bytes
  bool ended_ = false;  ///< all of the file is or was in the text
  TableHeader header_;
  std::optional<TableRow> first_row_;  ///< of a table without names, not yet returned
  char separator_ = ',';
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

}  // namespace

std::unique_ptr<TableSource> open_csv_table(const std::string& path) {
  return std::make_unique<CsvTable>(path);
}

}  // namespace waymark::importers
