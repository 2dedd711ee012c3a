// SPDX-License-Identifier: Apache-2.0
#include "core/json_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "core/printable.hpp"

namespace waymark::inline core {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns true if a number that no double can hold is too large rather than too small.
bool exceeds_double(std::string_view number) {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view mantissa = number.substr(0, exponent_at);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = std::min(mantissa.find_first_of("123456789"), mantissa.size());
  const auto digits = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  std::string_view exponent = number.substr(std::min(exponent_at + 1, number.size()));
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t power = 0;
  const auto [end, problem] = std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  if (problem == std::errc::result_out_of_range) return !exponent.starts_with('-');
  return power > -digits;
}

/// Reads a JSON text from left to right; the open brackets are its only memory.
class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  bool document() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (value_or_opening()) {
      if (value_follows_) continue;
      if (!after_value()) return false;
      if (open_.empty()) return true;
    }
    return false;
  }

  JsonFault fault() const {
    const std::string_view before = text_.substr(0, std::min(at_, text_.size()));
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0
    return {problem_, 1 + static_cast<std::size_t>(std::ranges::count(before, '\n')),
            1 + before.size() - line_begin};
  }

 private:
  bool fail(std::string problem) {
    problem_ = std::move(problem);
    return false;
  }
  bool at_end() const { return at_ >= text_.size(); }
  bool next_is(char c) const { return !at_end() && text_[at_] == c; }
  void skip_space() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  char closing() const { return open_.back() == '{' ? '}' : ']'; }

  /// Reads a scalar, an empty object or list, or an opening bracket up to its first value.
  bool value_or_opening() {
    skip_space();
    value_follows_ = false;
    if (at_end()) return fail("the text ends where a value is expected");
    const char c = text_[at_];
    if (c != '{' && c != '[') return scalar();
    if (open_.size() == kMaxJsonDepth)
      return fail("objects and lists are nested more than " + std::to_string(kMaxJsonDepth) + " deep");
    open_ += c;
    ++at_;
    skip_space();
    if (next_is(closing())) {
      ++at_;
      open_.pop_back();
      return true;
    }
    value_follows_ = true;
    return c == '[' || key();
  }

  /// Reads closing brackets after a value, up to the next value or the end of the text.
  bool after_value() {
    for (;;) {
      skip_space();
      if (open_.empty()) return at_end() || fail("there is more text after the end of the value");
      if (at_end())
        return fail(open_.back() == '{' ? "the text ends in an object" : "the text ends in a list");
      if (next_is(',')) {
        ++at_;
        return open_.back() == '[' || key();
      }
      if (!next_is(closing()))
        return fail(open_.back() == '{' ? "expected ',' or '}' after a member"
                                        : "expected ',' or ']' after a value");
      ++at_;
      open_.pop_back();
    }
  }

  bool key() {
    skip_space();
    if (!next_is('"')) return fail("expected a name in double quotes");
    if (!string()) return false;
    skip_space();
    if (!next_is(':')) return fail("expected ':' after a name");
    ++at_;
    return true;
  }

  bool scalar() {
    if (next_is('"')) return string();
    if (next_is('-') || is_digit(text_[at_])) return number();
    for (const std::string_view word : {"true", "false", "null"})
      if (text_.substr(at_).starts_with(word)) {
        at_ += word.size();
        return true;
      }
    return fail("expected a value");
  }

  bool digits() {
    const std::size_t begin = at_;
    while (!at_end() && is_digit(text_[at_])) ++at_;
    return at_ > begin || fail("expected a digit");
  }

  bool number() {
    const std::size_t begin = at_;
    if (next_is('-')) ++at_;
    if (next_is('0'))
      ++at_;
    else if (!digits())
      return false;
    if (next_is('.')) {
      ++at_;
      if (!digits()) return false;
    }
    if (next_is('e') || next_is('E')) {
      ++at_;
      if (next_is('+') || next_is('-')) ++at_;
      if (!digits()) return false;
    }
    const std::string_view text = text_.substr(begin, at_ - begin);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc::result_out_of_range || !exceeds_double(text)) return true;
    at_ = begin;
    return fail("the number " + std::string(text.substr(0, 24)) + (text.size() > 24 ? "..." : "") +
                " is too large: numbers go up to 1.797e308");
  }

  bool string() {
    ++at_;
    while (!at_end()) {
      const auto c = static_cast<unsigned char>(text_[at_]);
      if (c == '"') {
        ++at_;
        return true;
      }
      if (c < 0x20) return fail("a control character in a text must be written as \\n, \\t or \\u00XX");
      if (!(c == '\\' ? escape() : character())) return false;
    }
    return fail("a text has no closing quote");
  }

  bool escape() {
    ++at_;
    if (next_is('u')) {
      ++at_;
      const int first = hexadecimal();
      if (first < 0) return false;
      if (first >= 0xDC00 && first <= 0xDFFF) return fail("a low surrogate without a high one");
      if (first < 0xD800 || first > 0xDBFF) return true;
      if (!text_.substr(std::min(at_, text_.size())).starts_with("\\u"))
        return fail("a high surrogate without a low one");
      at_ += 2;
      const int second = hexadecimal();
      if (second < 0) return false;
      return (second >= 0xDC00 && second <= 0xDFFF) || fail("a high surrogate without a low one");
    }
    if (at_end() || std::string_view("\"\\/bfnrt").find(text_[at_]) == std::string_view::npos)
      return fail("a backslash must be written twice");
    ++at_;
    return true;
  }

  int hexadecimal() {
    int value = 0;
    const std::string_view four = text_.substr(std::min(at_, text_.size()), 4);
    const auto [end, problem] = std::from_chars(four.data(), four.data() + four.size(), value, 16);
    if (problem != std::errc() || end != four.data() + 4 || four.front() == '-') {
      fail("\\u must be followed by four hexadecimal digits");
      return -1;
    }
    at_ += 4;
    return value;
  }

  bool character() {
    const std::size_t length = utf8_length(text_.substr(at_));
    at_ += length;
    return length > 0 || fail("this is not UTF-8");
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::string open_;
  std::string problem_;
  bool value_follows_ = false;
};

}  // namespace

std::optional<JsonFault> find_json_fault(std::string_view text) {
  JsonScanner scanner(text);
  return scanner.document() ? std::nullopt : std::optional(scanner.fault());
}

std::string_view checked_json(std::string_view text, std::string_view origin, ErrorCode code) {
  if (const auto fault = find_json_fault(text))
    throw Error(code, "not valid JSON: " + fault->problem,
                std::string(origin) + ":" + std::to_string(fault->line) + ":" + std::to_string(fault->column),
                "correct it there; a damaged file must be written again");
  return text;
}

std::string_view json_or_empty(std::string_view text) {
  return find_json_fault(text) ? std::string_view() : text;
}

}  // namespace waymark::inline core
