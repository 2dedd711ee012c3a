// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/port.hpp"

#include <cxxabi.h>

#include <cstdlib>
#include <regex>

namespace waymark {
namespace {

std::string demangled(std::type_index type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(abi::__cxa_demangle(type.name(), nullptr, nullptr, &status),
                                                    std::free);
  return status == 0 ? name.get() : type.name();
}

}  // namespace

std::string readable_type(std::type_index type) {
  static const std::regex string(R"(std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >)");
  static const std::regex scope(R"((\(anonymous namespace\)|\w+)::)");
  static const std::regex allocator(R"(, allocator<[^<>]*(<[^<>]*>)?[^<>]*>)");
  static const std::regex constness(R"(([\w]+) const\b)");
  std::string name = std::regex_replace(demangled(type), string, "string");
  name = std::regex_replace(name, scope, "");
  name = std::regex_replace(name, allocator, "");
  name = std::regex_replace(name, constness, "const $1");
  return std::regex_replace(name, std::regex(" >"), ">");
}

}  // namespace waymark
