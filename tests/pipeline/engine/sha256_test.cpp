// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/sha256.hpp"
#include "tests/pipeline/engine/toy_test.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

// FIPS 180-4 examples.
TEST(Sha256, KnowsThePublishedSums) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256().add("a").add("").add("bc").hex(), sha256("abc"));
}

TEST(HashPlainFile, StreamsMoreThanOneBlock) {
  const TemporaryFolder folder;
  const std::string bytes(3'000'001, 'x');
  std::ofstream(folder / "big", std::ios::binary) << bytes;
  const InputFile file = hash_plain_file(folder / "big");
  EXPECT_EQ(file.path, (folder / "big").string());
  EXPECT_EQ(file.bytes, bytes.size());
  EXPECT_EQ(file.sha256, sha256(bytes));
}

TEST(HashPlainFile, SaysWhatItCannotRead) {
  EXPECT_EQ(message_of([] { hash_plain_file("/nowhere.tif"); }),
            "cannot read an input file: No such file or directory\n  /nowhere.tif\n"
            "  check the path in the job; it is relative to the job file");
  EXPECT_THROW(hash_plain_file("/tmp"), Error);
}

}  // namespace
}  // namespace waymark::test
