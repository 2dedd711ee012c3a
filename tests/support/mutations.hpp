// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
namespace waymark::test {

/// Kind of content, which decides the mutations that make sense.
enum class Content {
  text,    ///< JSON, CSV, XML, lines of words
  binary,  ///< numbers at fixed places
};

/// Returns the n-th mutation of a file's content: truncated, with flipped bytes, wild numbers, deep nesting,
/// removed or repeated lines, or huge counts. Equal arguments give equal bytes.
std::string mutate(std::string_view content, Content kind, std::size_t n);

}  // namespace waymark::test
