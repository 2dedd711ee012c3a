// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/pipeline/engine/toy_stages.hpp"
#include "tests/support/message_of.hpp"
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

}  // namespace waymark::test
