// SPDX-License-Identifier: Apache-2.0
#include "importers/images/find_images.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

// A camera file of somebody else names what it likes; only images beside it are read.
TEST(FindImages, NamesOfACameraFileStayInItsFolder) {
  std::string pattern = testing::TempDir() + "/find-images-XXXXXX";
  const fs::path folder = ::mkdtemp(pattern.data());
  fs::create_directories(folder / "site/images/left");
  for (const char* file : {"secret.png", "site/images/a.png", "site/images/left/b.png"})
    std::ofstream(folder / file) << "x";
  const auto path_of = [&](const std::string& name) {
    importers::CameraSet cameras;
    cameras.images.emplace_back().image = name;
    const auto found = importers::find_images({}, &cameras, (folder / "site/cameras.json").string());
    return found.empty() ? std::string() : fs::path(found[0].path).lexically_relative(folder).string();
  };
  EXPECT_EQ(path_of("a.png"), "site/images/a.png");
  EXPECT_EQ(path_of("left/b.png"), "site/images/left/b.png");
  EXPECT_EQ(path_of("../images/a.png"), "site/images/a.png");
  EXPECT_EQ(path_of((folder / "elsewhere/a.png").string()), "site/images/a.png");
  for (const std::string& name : {std::string("../../secret.png"), (folder / "secret.png").string(),
                                  std::string("left/../../../secret.png")})
    EXPECT_EQ(path_of(name), "site/secret.png") << "is not there, " << name;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace waymark::test
