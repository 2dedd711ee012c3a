// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mutations.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace waymark::test {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t bound) {
  return bound == 0 ? 0 : random() % bound;
}

std::string truncated(std::string text, Random& random) {
  text.resize(below(random, text.size() + 1));
  return text;
}

std::string with_flipped_bytes(std::string text, Random& random, std::size_t range) {
  for (std::size_t i = 1 + below(random, 8); i-- > 0 && !text.empty();)
    text[below(random, std::min(range, text.size()))] ^= static_cast<char>(1 << below(random, 8));
  return text;
}

/// Returns begin and end of the runs of characters that `belongs` accepts.
template <class Belongs>
std::vector<std::pair<std::size_t, std::size_t>> runs_of(std::string_view text, const Belongs& belongs) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!belongs(text[i])) continue;
    if (runs.empty() || runs.back().second != i) runs.emplace_back(i, i);
    runs.back().second = i + 1;
  }
  return runs;
}

std::string with_wild_number(std::string text, Random& random) {
  constexpr std::array kWild{
      "1e308", "-1e308",     "1e999", "nan", "-inf", "-1", "0",    "99999999999",          "1e18",   "-0.5",
      "null",  "4294967296", "\"x\"", "[]",  "{}",   "",   "1e30", "-9223372036854775808", "1e-320", "true"};
  const auto numbers = runs_of(
      text, [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-'; });
  if (numbers.empty()) return text;
  const auto [begin, end] = numbers[below(random, numbers.size())];
  return text.replace(begin, end - begin, kWild[below(random, kWild.size())]);
}

std::string with_changed_word(std::string text, Random& random) {
  const auto words = runs_of(text, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
  if (words.empty()) return text;
  const auto [begin, end] = words[below(random, words.size())];
  const std::array<std::string, 5> instead{"", "x", "\x1b[31m\x07\xff\xfe", std::string(100'000, 'a'),
                                           "\xe2\x80\xae" + text.substr(begin, end - begin)};
  return text.replace(begin, end - begin, instead[below(random, instead.size())]);
}

std::string with_deep_nesting(std::string text, Random& random) {
  constexpr std::array kBrackets{"[", "{\"a\":", "(", "<a>", "\""};
  const std::string bracket = kBrackets[below(random, kBrackets.size())];
  std::string nested;
  for (std::size_t i = 0; i < 20'000; ++i) nested += bracket;
  return text.insert(below(random, text.size() + 1), nested);
}

std::string with_changed_lines(const std::string& text, Random& random) {
  const auto lines = runs_of(text, [](char c) { return c != '\n'; });
  if (lines.empty()) return text;
  const auto line = [&](std::size_t i) {
    return text.substr(lines[i].first, lines[i].second - lines[i].first) + '\n';
  };
  const std::size_t chosen = below(random, lines.size()), copies = 3 * below(random, 2);
  std::string changed;
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (std::size_t copy = i == chosen ? copies : 1; copy > 0; --copy) changed += line(i);
  return changed;
}

std::string with_junk(std::string text, Random& random) {
  std::string junk(1 + below(random, 64), '\0');
  for (char& c : junk) c = static_cast<char>(random());
  return text.replace(below(random, text.size() + 1), junk.size(), junk);
}

/// Overwrites bytes with an extreme integer or real number, small or big endian.
std::string with_extreme_value(std::string bytes, Random& random, std::size_t range) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr std::array<double, 6> kReals{kInf, -kInf, std::numeric_limits<double>::quiet_NaN(), 1e308, 0, -1};
  constexpr std::array<std::uint64_t, 8> kCounts{
      0, 0xFFFF, 0x7FFFFFFF, 0xFFFFFFFF, 0x80000000, 0x10000000, 0x7FFFFFFFFFFFFFFF, ~std::uint64_t{0}};
  std::array<char, 8> value{};
  std::size_t length = 8;
  if (below(random, 3) == 0) {
    std::memcpy(value.data(), &kReals[below(random, kReals.size())], 8);
  } else {
    std::memcpy(value.data(), &kCounts[below(random, kCounts.size())], 8);
    length = std::size_t{1} << below(random, 4);
    if (below(random, 4) == 0)
      std::reverse(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(length));
  }
  range = std::min(range, bytes.size());
  if (range < length) return bytes;
  return bytes.replace(below(random, range - length + 1), length, value.data(), length);
}

}  // namespace

std::string mutate(std::string_view content, Content kind, std::size_t n) {
  Random random(n);
  const std::string text(content);
  constexpr std::size_t kHead = 512;
  if (kind == Content::text) switch (n % 8) {
      case 0:
        return truncated(text, random);
      case 1:
        return with_flipped_bytes(text, random, text.size());
      case 2:
      case 3:
        return with_wild_number(text, random);
      case 4:
        return with_changed_word(text, random);
      case 5:
        return n % 40 == 5 ? with_deep_nesting(text, random) : with_wild_number(text, random);
      case 6:
        return with_changed_lines(text, random);
      default:
        return with_junk(text, random);
    }
  switch (n % 6) {
    case 0:
      return truncated(text, random);
    case 1:
      return with_flipped_bytes(text, random, text.size());
    case 2:
      return with_flipped_bytes(text, random, kHead);
    case 3:
      return with_extreme_value(text, random, text.size());
    case 4:
      return with_extreme_value(text, random, kHead);
    default:
      return with_junk(text, random);
  }
}

}  // namespace waymark::test
