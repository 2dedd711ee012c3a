// SPDX-License-Identifier: Apache-2.0
// Files that name others on the network.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "made_dem.hpp"
#include "program.hpp"

namespace waymark::test {
namespace {

/// A port of this machine that answers nothing, and counts who connects.
class Port {
 public:
  Port() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    ::sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* const plain = reinterpret_cast<::sockaddr*>(&address);
    ::socklen_t size = sizeof address;
    if (::bind(socket_, plain, size) != 0 || ::listen(socket_, 16) != 0 ||
        ::getsockname(socket_, plain, &size) != 0 || ::fcntl(socket_, F_SETFL, O_NONBLOCK) != 0)
      throw std::runtime_error("no port");
    address_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  }
  ~Port() { ::close(socket_); }
  const std::string& address() const { return address_; }
  int connections() const {
    int count = 0;
    for (int one; (one = ::accept(socket_, nullptr, nullptr)) >= 0; ++count) ::close(one);
    return count;
  }

 private:
  int socket_;
  std::string address_;
};

class Network : public testing::Test {
 protected:
  /// A virtual raster whose cells are those of `source`.
  std::string vrt(const std::string& source) {
    write_text(folder_ / "a.vrt",
               "<VRTDataset rasterXSize='9' "
               "rasterYSize='9'><SRS>EPSG:32632</SRS><GeoTransform>500000,10,0,5200000,0,-10"
               "</GeoTransform><VRTRasterBand dataType='Float32' band='1'><SimpleSource><SourceFilename>" +
                   source +
                   "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
    return folder_ / "a.vrt";
  }
  Outcome peaks(const std::string& dem, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"peaks",    dem,
                                   "-o",       folder_ / "map.gpkg",
                                   "--config", "GDAL_HTTP_TIMEOUT=1",
                                   "--config", "GDAL_HTTP_MAX_RETRY=0"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  TempFolder folder_;
  Port port_;
};

TEST_F(Network, IsNotReachedByFilesThatNameIt) {
  for (const std::string& source : {"/vsicurl/" + port_.address() + "/a.tif", port_.address() + "/a.tif",
                                    "/vsicurl_streaming/" + port_.address() + "/a.tif"}) {
    const Outcome said = peaks(vrt(source));
    EXPECT_EQ(said.code, 1) << source;
    EXPECT_NE(said.err, "");
    EXPECT_EQ(port_.connections(), 0) << source;
  }
  write_text(folder_ / "a.geojson", R"({"type": "FeatureCollection", "features": []})");
  write_text(folder_ / "names.vrt", "<OGRVRTDataSource><OGRVRTLayer name='a'><SrcDataSource>" +
                                        port_.address() +
                                        "/a.geojson</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>");
  waymark({"import", folder_ / "names.vrt", "-o", folder_ / "map.gpkg", "--type", "rock"});
  EXPECT_EQ(port_.connections(), 0);
}

TEST_F(Network, IsReachedIfAllowedOrTyped) {
  const std::string source = "/vsicurl/" + port_.address() + "/a.tif";
  peaks(vrt(source), {"--allow-network"});
  EXPECT_GT(port_.connections(), 0);
  peaks(source);
  EXPECT_GT(port_.connections(), 0);
}

/// A DEM on a server of this machine, and the words that run lines of bash in its folder beside that server.
class DemOnAServer : public testing::Test {
 protected:
  void SetUp() override {
    MadeDem dem = hills(1500, 1500);
    dem.compressed_blocks = true;
    std::filesystem::create_directory(folder_ / "served");
    make_dem(folder_ / "served/hills.tif", dem);
    bash("touch -d 2020-01-01 '" + (folder_ / "served/hills.tif") + "'; ln -s \"$WAYMARK\" '" +
         (folder_ / "waymark") + "'");
  }
  /// Runs lines in which $server is the address, and returns what the server sent last.
  Outcome beside_server(const std::string& lines) {
    write_text(folder_ / "lines", "set -e\n" + lines);
    return bash("cd '" + folder_.path().string() +
                "'; export PATH=$PWD:$PATH SOURCE_DATE_EPOCH=0; timeout 300 /usr/bin/python3 '" +
                WAYMARK_SOURCE_DIR + "/tests/apps/serve_folder.py' served env server={url} bash lines");
  }
  static std::uintmax_t bytes_sent(const Outcome& said) {
    std::uintmax_t bytes = 0;
    const auto served = nlohmann::json::parse(said.out.substr(said.out.rfind("[[")));
    for (const auto& answer : served) bytes += answer.at(1).get<std::uintmax_t>();
    return bytes;
  }
  std::string landmarks(const std::string& map) {
    return waymark({"query", folder_ / map, "--format", "csv"}).out;
  }
  TempFolder folder_;
};

TEST_F(DemOnAServer, HasTheSummitsOfTheFile) {
  const Outcome said = beside_server(
      "waymark peaks /vsicurl/$server/hills.tif -o map.gpkg -q\n"
      "waymark peaks served/hills.tif -o local.gpkg -q\n");
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_GT(landmarks("map.gpkg").size(), 1000U);
  EXPECT_EQ(landmarks("map.gpkg"), landmarks("local.gpkg"));
}

// The calls of a plan read the DEM whole once among them all, for its checksum, and not each of the thirteen.
TEST_F(DemOnAServer, IsReadByTheCallsOfAPlanFewTimes) {
  if (bash("parallel --version | grep GNU").code != 0) GTEST_SKIP() << "needs GNU parallel";
  const Outcome said = beside_server(
      "waymark peaks /vsicurl/$server/hills.tif --tile-cells 128 --print-job > job.json\n"
      "! waymark plan job.json -q 2> refusal\n"
      "waymark plan job.json --format parallel --allow-network --config GDAL_HTTP_TIMEOUT=60 --shards 8"
      " -o map.gpkg > run.sh\n"
      "sh run.sh\n"
      "waymark peaks served/hills.tif -o local.gpkg -q\n");
  ASSERT_EQ(said.code, 0) << said.err;
  EXPECT_THAT(text_of(folder_ / "refusal"), testing::HasSubstr("--allow-network"));
  EXPECT_THAT(text_of(folder_ / "run.sh"),
              testing::HasSubstr("--allow-network --config '\\''GDAL_HTTP_TIMEOUT=60'\\''"));
  EXPECT_EQ(landmarks("map.gpkg"), landmarks("local.gpkg"));
  const auto size = std::filesystem::file_size(folder_ / "served/hills.tif");
  ASSERT_GT(size, 1U << 20);
  EXPECT_LT(bytes_sent(said), 8 * size);
}

}  // namespace
}  // namespace waymark::test
