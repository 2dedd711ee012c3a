// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <concepts>
#include <string>

#include "core/error.hpp"
namespace waymark::test {

/// Returns the message of the error that `action` throws; fails the test if it throws none.
template <class Expected = Error>
std::string message_of(std::invocable auto&& action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace waymark::test
