// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/engine/toy_stages.hpp"
namespace waymark::test {
using namespace pipeline;

/// Fixture with the toy pipeline, a reset watch and a work folder.
class ToyTest : public testing::Test {
 protected:
  ToyTest() { reset_watch(); }
  ~ToyTest() override { reset_watch(); }

  /// Returns how often each stage ran since the last call: listed, squared, summed.
  std::vector<int> ran() {
    return {toy::watch().listed.exchange(0), toy::watch().squared.exchange(0),
            toy::watch().summed.exchange(0)};
  }
  /// Returns the sum computed by the pipeline.
  static std::string sum_of(const RunResult& result) { return result.artifact<std::string>("sum"); }

  const Registry registry = toy::registry();
  Pipeline pipeline = toy_pipeline(registry);
  const TemporaryFolder work;

 private:
  void reset_watch() {
    ran();
    toy::watch().in_square = {};
  }
};

/// Returns the message of the Error that `action` throws; fails the test if it throws none.
template <class Expected = Error>
std::string message_of(auto action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace waymark::test
