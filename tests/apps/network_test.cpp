// SPDX-License-Identifier: Apache-2.0
// Files that name others on the network.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

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

}  // namespace
}  // namespace waymark::test
