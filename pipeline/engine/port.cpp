// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/port.hpp"

#include <cxxabi.h>

#include <cctype>
#include <cstdlib>
#include <string_view>

namespace waymark::pipeline {
namespace {

std::string demangle(std::type_index type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  return status == 0 ? name.get() : type.name();
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

bool is_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Removes namespaces: "std::vector<(anonymous namespace)::Number>" becomes "vector<Number>".
void erase_scopes(std::string& name) {
  for (std::size_t colons; (colons = name.find("::")) != std::string::npos;) {
    std::size_t begin = colons;
    if (begin > 0 && name[begin - 1] == ')') begin = name.rfind('(', begin);
    while (begin > 0 && is_word(name[begin - 1])) --begin;
    name.erase(begin, colons + 2 - begin);
  }
}

/// Removes allocators at any depth: "vector<Number, allocator<Number>>" becomes "vector<Number>".
void erase_allocators(std::string& name) {
  constexpr std::string_view kBegin = ", allocator<";
  for (std::size_t begin = 0; (begin = name.find(kBegin)) != std::string::npos;) {
    std::size_t end = begin + kBegin.size();
    for (int open = 1; open > 0 && end < name.size(); ++end)
      open += name[end] == '<' ? 1 : name[end] == '>' ? -1 : 0;
    name.erase(begin, end - begin);
  }
}

/// Moves `const` to the front: "shared_ptr<Number const>" becomes "shared_ptr<const Number>".
void move_const_forward(std::string& name) {
  constexpr std::string_view kConst = " const";
  for (std::size_t at; (at = name.find(kConst)) != std::string::npos;) {
    std::size_t begin = at;
    while (begin > 0 && is_word(name[begin - 1])) --begin;
    if (begin == at) return;  // not after a plain word: the rest stays
    name.erase(at, kConst.size()).insert(begin, "const ");
  }
}

}  // namespace

std::string readable_type(std::type_index type) {
  std::string name = demangle(type);
  replace_all(name, "std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >",
              "string");
  erase_scopes(name);
  replace_all(name, " >", ">");
  move_const_forward(name);
  erase_allocators(name);
  return name;
}

}  // namespace waymark::pipeline
