// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/port.hpp"

#include <cxxabi.h>

#include <cstdlib>
#include <regex>
#include <string_view>

namespace waymark {
namespace {

std::string demangled(std::type_index type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  return status == 0 ? name.get() : type.name();
}

/// "vector<Number, allocator<Number>>" becomes "vector<Number>", however deep the brackets nest.
std::string without_allocators(std::string name) {
  constexpr std::string_view kBegin = ", allocator<";
  for (std::size_t begin = 0; (begin = name.find(kBegin)) != std::string::npos;) {
    std::size_t end = begin + kBegin.size();
    for (int open = 1; open > 0 && end < name.size(); ++end)
      open += name[end] == '<' ? 1 : name[end] == '>' ? -1 : 0;
    name.erase(begin, end - begin);
  }
  return name;
}

}  // namespace

std::string readable_type(std::type_index type) {
  static const std::regex string(
      "std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >");
  static const std::regex scope(R"((\(anonymous namespace\)|\w+)::)");
  static const std::regex constness(R"((\w+) const\b)");
  static const std::regex space(" >");
  std::string name = std::regex_replace(demangled(type), string, "string");
  name = std::regex_replace(name, scope, "");
  name = std::regex_replace(name, constness, "const $1");
  name = std::regex_replace(name, space, ">");
  return without_allocators(name);
}

}  // namespace waymark
