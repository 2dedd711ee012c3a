// SPDX-License-Identifier: Apache-2.0
#include "importers/tables/table_expression.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "core/units.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::importers {
namespace {

using Operation = double (*)(double, double);
using Nodes = std::vector<std::unique_ptr<const TableExpression::Node>>;
constexpr int kMaxDepth = 200;  // nested parentheses

struct Function {
  std::string_view name;
  std::size_t arguments;
  Operation apply;
};

constexpr std::array kFunctions = {
    Function{"sqrt", 1, [](double a, double) { return std::sqrt(a); }},
    Function{"abs", 1, [](double a, double) { return std::abs(a); }},
    Function{"exp", 1, [](double a, double) { return std::exp(a); }},
    Function{"log", 1, [](double a, double) { return std::log(a); }},
    Function{"log10", 1, [](double a, double) { return std::log10(a); }},
    Function{"sin", 1, [](double a, double) { return std::sin(a); }},
    Function{"cos", 1, [](double a, double) { return std::cos(a); }},
    Function{"tan", 1, [](double a, double) { return std::tan(a); }},
    Function{"deg", 1, [](double a, double) { return a / kRadiansPerDegree; }},
    Function{"rad", 1, [](double a, double) { return a * kRadiansPerDegree; }},
    Function{"min", 2, [](double a, double b) { return std::isnan(a) || a < b ? a : b; }},
    Function{"max", 2, [](double a, double b) { return std::isnan(a) || a > b ? a : b; }},
};

bool is_letter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalpha(byte) || c == '_' || byte >= 0x80;
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

struct TableExpression::Node {
  Operation apply = nullptr;  // null: a constant or a column
  double constant = 0;
  std::size_t column = kNoColumn;
  Nodes of = {};

  static constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);
};

namespace {

using Node = TableExpression::Node;
using NodePointer = std::unique_ptr<const Node>;

class Parser {
 public:
  Parser(std::string_view text, const std::vector<std::string>& columns) : text_(text), columns_(columns) {}

  NodePointer parse() {
    NodePointer all = sum();
    skip();
    if (at_ < text_.size()) fail(fmt::format("'{}' is not expected here", text_.substr(at_, 1)));
    return all;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::usage, problem, fmt::format("{}\n  {:>{}}", text_, '^', at_ + 1),
                "columns, numbers, + - * / ^, parentheses and functions such as sqrt() may be used; quote "
                "names with blanks: \"Diameter (km)\"");
  }

  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  static NodePointer join(Operation apply, NodePointer a, NodePointer b) {
    auto node = std::make_unique<Node>();
    node->apply = apply;
    node->of.push_back(std::move(a));
    if (b) node->of.push_back(std::move(b));
    return node;
  }
  static NodePointer constant(double value) {
    auto node = std::make_unique<Node>();
    node->constant = value;
    return node;
  }

  NodePointer sum() {
    if (++depth_ > kMaxDepth) fail("the expression is nested too deeply");
    NodePointer left = term();
    for (;;) {
      if (take('+'))
        left = join([](double a, double b) { return a + b; }, std::move(left), term());
      else if (take('-'))
        left = join([](double a, double b) { return a - b; }, std::move(left), term());
      else
        return --depth_, std::move(left);
    }
  }

  NodePointer term() {
    NodePointer left = power();
    for (;;) {
      if (take('*'))
        left = join([](double a, double b) { return a * b; }, std::move(left), power());
      else if (take('/'))
        left = join([](double a, double b) { return a / b; }, std::move(left), power());
      else
        return left;
    }
  }

  NodePointer power() {
    if (++depth_ > kMaxDepth) fail("the expression is nested too deeply");
    NodePointer result;
    if (take('-')) {
      result = join([](double a, double) { return -a; }, power(), nullptr);
    } else {
      result = value();
      if (take('^'))
        result = join([](double a, double b) { return std::pow(a, b); }, std::move(result), power());
    }
    --depth_;
    return result;
  }

  NodePointer value() {
    skip();
    if (at_ >= text_.size()) fail("the expression ends too early");
    if (take('(')) {
      NodePointer inner = sum();
      if (!take(')')) fail("a parenthesis is not closed");
      return inner;
    }
    const char c = text_[at_];
    if (c == '"' || c == '`') return quoted(c);
    if (is_digit(c) || c == '.') return number();
    if (is_letter(c)) return name();
    fail(fmt::format("'{}' is not expected here", c));
  }

  NodePointer number() {
    double value = 0;
    const auto [stop, fault] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (fault != std::errc{}) fail("this is no number");
    at_ = static_cast<std::size_t>(stop - text_.data());
    return constant(value);
  }

  NodePointer quoted(char quote) {
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == std::string_view::npos) fail("a quote is not closed");
    const std::string_view name = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return column(name);
  }

  NodePointer name() {
    const std::size_t start = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    if (take('(')) return call(word);
    const bool own = std::ranges::any_of(
        columns_, [&](const std::string& c) { return lower_case(c) == lower_case(word); });
    return word == "pi" && !own ? constant(std::numbers::pi) : column(word);
  }

  NodePointer call(std::string_view word) {
    const auto* function = std::ranges::find(kFunctions, lower_case(word), &Function::name);
    if (function == kFunctions.end()) fail(fmt::format("there is no function '{}'", word));
    NodePointer first = sum(), second;
    if (function->arguments == 2) {
      if (!take(',')) fail(fmt::format("{} takes two values", word));
      second = sum();
    }
    if (!take(')')) fail("a parenthesis is not closed");
    return join(function->apply, std::move(first), std::move(second));
  }

  NodePointer column(std::string_view name) const {
    auto node = std::make_unique<Node>();
    node->column = column_index(columns_, name);
    return node;
  }

  std::string_view text_;
  const std::vector<std::string>& columns_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

double evaluate(const Node& node, const TableRow& row, const TableSource& table) {
  if (node.apply != nullptr) {
    const double a = evaluate(*node.of[0], row, table);
    return node.apply(a, node.of.size() > 1 ? evaluate(*node.of[1], row, table) : 0);
  }
  if (node.column == Node::kNoColumn) return node.constant;
  const std::string& cell = row.cells[node.column];
  if (is_missing(cell)) return std::nan("");
  if (const auto number = to_real(cell, table.header().decimal_comma)) return *number;
  throw Error(ErrorCode::input,
              fmt::format("'{}' is no number, in column '{}'", cell, table.header().columns[node.column]),
              table.row_location(row),
              "correct it, leave it empty, or pass --skip-bad-rows to go on without such rows");
}

}  // namespace

TableExpression::TableExpression(std::string_view text, const std::vector<std::string>& columns)
    : text_(text), root_(Parser(text_, columns).parse()) {}
TableExpression::~TableExpression() = default;
TableExpression::TableExpression(TableExpression&&) noexcept = default;
TableExpression& TableExpression::operator=(TableExpression&&) noexcept = default;

double TableExpression::value(const TableRow& row, const TableSource& table) const {
  const double result = evaluate(*root_, row, table);
  return std::isfinite(result) ? result : std::nan("");
}

bool TableExpression::is_column() const {
  return root_->column != Node::kNoColumn;
}

void TableExpression::add_columns(std::set<std::size_t>& used) const {
  std::vector<const Node*> open{root_.get()};
  while (!open.empty()) {
    const Node* node = open.back();
    open.pop_back();
    if (node->column != Node::kNoColumn) used.insert(node->column);
    for (const auto& part : node->of)
      if (part) open.push_back(part.get());
  }
}

const std::string& TableExpression::word(const TableRow& row) const {
  if (!is_column()) throw Error(ErrorCode::usage, "a name must be a column, not '" + text_ + "'");
  return row.cells[root_->column];
}

std::size_t column_index(const std::vector<std::string>& columns, std::string_view name) {
  const auto exact = std::ranges::find(columns, name);
  if (exact != columns.end() && std::ranges::count(columns, name) == 1)
    return static_cast<std::size_t>(exact - columns.begin());
  std::vector<std::size_t> like;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (lower_case(columns[i]) == lower_case(name)) like.push_back(i);
  if (like.size() == 1) return like[0];
  const std::string nearest = nearest_name(name, columns);
  throw Error(ErrorCode::usage,
              fmt::format("the table has {} '{}'", like.empty() ? "no column" : "several columns", name), "",
              !like.empty()      ? "rename them in the table's header"
              : !nearest.empty() ? fmt::format("did you mean '{}'?", nearest)
                                 : fmt::format("it has {}", fmt::join(columns, ", ")));
}

}  // namespace waymark::importers
