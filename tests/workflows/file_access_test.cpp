// SPDX-License-Identifier: Apache-2.0
#include "workflows/file_access.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <fstream>

#include "core/error.hpp"
#include "workflows/mapping/make_map.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using namespace workflows;
using testing::AllOf;
using testing::HasSubstr;

TEST(IsOnNetwork, KnowsAddressesFileSystemsAndServices) {
  for (const char* path : {"/vsicurl/https://a.org/b.tif", "https://a.org/b.geojson", "/VSICURL/http://a",
                           "/vsizip/vsicurl/x.zip/a.tif", "/vsis3/bucket/a.tif", "PG:host=a", "wms:http"})
    EXPECT_TRUE(is_on_network(path)) << path;
  for (const char* path : {"a.tif", "/data/pg/a.tif", "../wms/a.tif", "/vsizip/a.zip/b.tif",
                           "NETCDF:a.nc:height", "EPSG:32632", "C:/a.tif", "/vsistdin/"})
    EXPECT_FALSE(is_on_network(path)) << path;
  EXPECT_TRUE(names_network(std::vector<std::string>{"run", "--set", "load_dem.files=/vsicurl/http://a"}));
  EXPECT_TRUE(names_network(std::vector<std::string>{"import", "pg:dbname=a"}));
  EXPECT_FALSE(names_network(std::vector<std::string>{"peaks", "a.tif", "-o", "b.gpkg"}));
}

class JobFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/job-files-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    fs::create_directories(folder_ / "job/tiles");
    std::ofstream(folder_ / "other.tif") << "x";
    std::ofstream(folder_ / "job/tiles/a.tif") << "x";
    fs::create_symlink("../other.tif", folder_ / "job/link.tif");
  }
  void TearDown() override { fs::remove_all(folder_); }
  /// Returns the message about a job whose DEM is `file`; empty if it is accepted.
  std::string refusal(const std::string& file, bool confined = true) {
    const fs::path job = folder_ / "job/job.json";
    std::ofstream(job) << R"({"stages": [{"stage": "load_dem", "files": [")" + file + R"("]}]})";
    try {
      load_job(job, {}, confined);
      return {};
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::usage);
      return error.what();
    }
  }
  fs::path folder_;
};

TEST_F(JobFiles, InItsFolderAreAccepted) {
  for (const std::string& file :
       {std::string("tiles/a.tif"), std::string("tiles/../tiles/a.tif"),
        std::string("/vsizip/tiles/a.zip/b.tif"), (folder_ / "job/tiles/a.tif").string()})
    EXPECT_EQ(refusal(file), "") << file;
}

TEST_F(JobFiles, OutsideItsFolderAreRefusedIfConfined) {
  for (const std::string& file :
       {std::string("../other.tif"), std::string("/etc/passwd"), std::string("link.tif"),
        std::string("tiles/../../other.tif"), std::string("/vsizip//etc/a.zip/b.tif")}) {
    EXPECT_THAT(refusal(file), AllOf(HasSubstr("outside its folder: load_dem.files = " + file),
                                     HasSubstr("job.json"), HasSubstr("--confined")));
    EXPECT_EQ(refusal(file, false), "") << file;
  }
}

TEST_F(JobFiles, OnTheNetworkAreRefused) {
  EXPECT_THAT(refusal("/vsicurl/https://a.org/b.tif"),
              AllOf(HasSubstr("on the network: load_dem.files"), HasSubstr("--allow-network")));
}

}  // namespace
}  // namespace waymark::test
