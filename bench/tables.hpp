// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>
namespace waymark::bench {

/// Tables with the same columns, as Markdown and as an HTML page.
class Tables {
 public:
  explicit Tables(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  void site(const std::string& title) {
    md_ += fmt::format("\n## {}\n\n| {} |\n|", title, fmt::join(columns_, " | "));
    html_ += fmt::format("{}<h2>{}</h2>\n<table><tr>", html_.empty() ? "" : "</table>\n", title);
    for (const std::string& column : columns_) md_ += "---|", html_ += "<th>" + column + "</th>";
    md_ += "\n";
    html_ += "</tr>\n";
  }
  void row(const std::vector<std::string>& cells) {
    md_ += fmt::format("| {} |\n", fmt::join(cells, " | "));
    html_ += fmt::format("<tr><td>{}</td></tr>\n", fmt::join(cells, "</td><td>"));
  }

  const std::string& markdown() const { return md_; }
  std::string html(const std::string& title) const {
    return fmt::format(
        "<!doctype html><meta charset=\"utf-8\"><title>{0}</title><style>body{{font-family:sans-serif}}"
        "td,th{{padding:2px 8px;text-align:right}}td:first-child{{text-align:left}}"
        "tr:nth-child(even){{background:#f3f3f3}}</style>\n<h1>{0}</h1>\n{1}</table>\n",
        title, html_);
  }

 private:
  std::vector<std::string> columns_;
  std::string md_, html_;
};

}  // namespace waymark::bench
