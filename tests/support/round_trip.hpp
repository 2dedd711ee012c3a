// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "pipeline/engine/codec.hpp"
namespace waymark::test {

/// Expects that a value comes back: encoded again it gives the same bytes, and neither a part of them nor
/// more is a value. Of the parts about `parts` are tried.
template <class T>
void expect_round_trip(const T& value, std::size_t parts = 1'000'000) {
  using pipeline::Codec;
  const std::string bytes = Codec<T>::encode(value);
  EXPECT_EQ(Codec<T>::encode(Codec<T>::decode(bytes)), bytes);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / parts)
    EXPECT_THROW(Codec<T>::decode(std::string_view(bytes).substr(0, size)), std::runtime_error) << size;
  EXPECT_THROW(Codec<T>::decode(bytes + "x"), std::runtime_error);
}

}  // namespace waymark::test
