// SPDX-License-Identifier: Apache-2.0
// How long the program takes until it works.
#include <gtest/gtest.h>

#include <algorithm>

#include "program.hpp"

namespace waymark::test {
namespace {

/// Processor time of a run, milliseconds.
double milliseconds_of(const std::vector<std::string>& words) {
  const rusage usage = usage_of_waymark(words);
  const auto of = [](const timeval& time) {
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-3 * static_cast<double>(time.tv_usec);
  };
  return of(usage.ru_utime) + of(usage.ru_stime);
}

// 60 ms are asked, and 40 to 50 measured; slower machines and those with other work get twice the time.
// GDAL's drivers took 136 ms while they were loaded at every start.
TEST(Start, LoadsOnlyWhatACommandNeeds) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer starts slowly";
#endif
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--version"}, {"types", "--format", "json"}, {"peaks", "--help"}}) {
    double shortest = 1e9;
    for (int i = 0; i < 5; ++i) shortest = std::min(shortest, milliseconds_of(words));
    EXPECT_LT(shortest, 120) << words[0];
  }
}

}  // namespace
}  // namespace waymark::test
