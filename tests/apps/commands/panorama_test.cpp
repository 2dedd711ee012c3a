// SPDX-License-Identifier: Apache-2.0
// `waymark localize --method global --dem` on one panorama of the horizon.
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "core/random.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;

constexpr double kHalfTurn = std::numbers::pi, kOneDegree = kHalfTurn / 180;
constexpr double kEye = 2;  // m, the default of the setting `eye`

const std::filesystem::path kSource = WAYMARK_SOURCE_DIR;
const std::filesystem::path kDems = kSource / "../shared/data/dem/earth";

/// A DEM in degrees, read by GDAL alone.
struct DegreeDem {
  int columns = 0, rows = 0;
  double west = 0, north = 0, dx = 1, dy = -1;  // of the middle of the first cell
  std::vector<float> heights;

  explicit DegreeDem(const std::filesystem::path& file) {
    GDALAllRegister();
    const std::unique_ptr<GDALDataset> set(GDALDataset::Open(file.c_str()));
    double g[6];
    set->GetGeoTransform(g);
    columns = set->GetRasterXSize(), rows = set->GetRasterYSize();
    west = g[0] + g[1] / 2, dx = g[1], north = g[3] + g[5] / 2, dy = g[5];
    heights.resize(std::size_t(columns) * std::size_t(rows));
    GDALRasterBand* band = set->GetRasterBand(1);
    EXPECT_EQ(band->RasterIO(GF_Read, 0, 0, columns, rows, heights.data(), columns, rows, GDT_Float32, 0, 0),
              CE_None);
    int has = 0;
    const double none = band->GetNoDataValue(&has);
    for (float& h : heights)
      if ((has && double(h) == none) || h < -1000) h = std::nanf("");
  }
  /// Bilinear; NaN outside and beside cells without a height.
  double operator()(double lon, double lat) const {
    const double c = (lon - west) / dx, r = (lat - north) / dy;
    if (!(c >= 0 && r >= 0 && c < columns - 1 && r < rows - 1)) return NAN;
    const auto c0 = std::size_t(c), r0 = std::size_t(r);
    const double u = c - double(c0), v = r - double(r0);
    const float* low = &heights[r0 * std::size_t(columns) + c0];
    const float* high = low + columns;
    return (1 - v) * ((1 - u) * double(low[0]) + u * double(low[1])) +
           v * ((1 - u) * double(high[0]) + u * double(high[1]));
  }
  double lon(double part) const { return west + part * dx * (columns - 1); }
  double lat(double part) const { return north + part * dy * (rows - 1); }
};

/// Metres per degree on WGS 84 at a latitude.
struct MetresPerDegree {
  double east, north;
  explicit MetresPerDegree(double lat) {
    const double e2 = 0.00669438, s = std::sin(lat * kOneDegree), w = 1 - e2 * s * s;
    east = 6378137 / std::sqrt(w) * std::cos(lat * kOneDegree) * kOneDegree;
    north = 6378137 * (1 - e2) / (w * std::sqrt(w)) * kOneDegree;
  }
};

/// The horizon by short steps along rays, with curvature and refraction.
std::vector<double> horizon(const DegreeDem& dem, double lon, double lat, double yaw, int count) {
  const MetresPerDegree here(lat);
  const double eye = dem(lon, lat) + kEye;
  std::vector<double> elevations;
  for (int i = 0; i < count; ++i) {
    const double azimuth = yaw - kHalfTurn + 2 * kHalfTurn * i / count;  // from east towards north
    double highest = -1;
    for (double t = 60; t < 60000; t += 30 + 0.001 * t) {
      // A geodesic to second order (Legendre); a line of one azimuth would miss by 200 m in 50 km.
      const double east = t * std::cos(azimuth), north = t * std::sin(azimuth);
      const double bend = std::tan(lat * kOneDegree) / 6378137;
      const double to_lat = lat + (north - east * east * bend / 2) / here.north;
      const double to_lon = lon + east * (1 + north * bend) / here.east;
      const double rise = (dem(to_lon, to_lat) - eye - 0.87 * t * t / (2 * 6371000)) / t;
      if (rise > highest) highest = rise;
    }
    elevations.push_back(std::atan(highest));
  }
  return elevations;
}

std::string panorama_log(std::vector<double> elevations, double sd, Random& random) {
  json items = json::array();
  for (const double e : elevations)
    items.push_back(random.bernoulli(0.02) ? json() : json(e + sd * random.normal()));
  const json line{{"kind", "panorama"},        {"t", 0},
                  {"first_angle", -kHalfTurn}, {"angle_step", 2 * kHalfTurn / double(elevations.size())},
                  {"elevation_sd", sd},        {"elevations", items}};
  return json{{"kind", "header"}, {"version", 1}, {"frame", "map"}}.dump() + "\n" + line.dump() + "\n";
}

std::map<std::string, double> last_row(const std::string& csv) {
  std::istringstream in(csv);
  std::string names, line, last;
  std::getline(in, names);
  while (std::getline(in, line)) last = line;
  std::istringstream columns(names), cells(last);
  std::map<std::string, double> row;
  for (std::string name, cell; std::getline(columns, name, ',') && std::getline(cells, cell, ',');)
    if (name != "crs") row[name] = cell.empty() ? NAN : std::stod(cell);
  return row;
}

struct Counts {
  int right = 0, wrong = 0, unknown = 0;
  std::vector<double> errors, nees;
};

/// Simulates panoramas at random positions of a DEM, each located by the command.
Counts locate_panoramas(const std::filesystem::path& file, int tries, std::uint64_t seed,
                        const std::string& prominence, const std::filesystem::path& searched = {}) {
  const DegreeDem dem(file);
  const std::string search_dem = (searched.empty() ? file : searched).string();
  TempFolder folder;
  const Outcome made =
      waymark({"peaks", search_dem, "-o", folder / "summits.gpkg", "--min-prominence", prominence});
  EXPECT_EQ(made.code, 0) << made.err;
  Random random(seed, "panoramas");
  Counts counts;
  for (int i = 0; i < tries;) {
    const double lon = dem.lon(random.uniform(0.2, 0.8)), lat = dem.lat(random.uniform(0.2, 0.8)),
                 yaw = random.uniform(-kHalfTurn, kHalfTurn);
    if (!std::isfinite(dem(lon, lat)) || dem(lon, lat) < 1) continue;
    ++i;
    write_text(folder / "log.jsonl", panorama_log(horizon(dem, lon, lat, yaw, 1440), 0.001, random));
    const Outcome said =
        waymark({"localize", folder / "summits.gpkg", folder / "log.jsonl", "-o", folder / "track.csv",
                 "--method", "global", "--dem", search_dem, "--crs", "--format", "json"});
    EXPECT_EQ(said.code, 0) << said.err;
    if (said.code != 0) return counts;
    auto row = last_row(text_of(folder / "track.csv"));
    const json result = json::parse(said.out);
    EXPECT_GE(double(result["wrong_probability"]), 0);
    if (row.at("lost") != 0) {
      std::cout << result["search_reason"] << " " << result["wrong_probability"] << "\n";
      ++counts.unknown;
      continue;
    }
    const MetresPerDegree here(lat);
    const Eigen::Vector2d off((row.at("x") - lon) * here.east, (row.at("y") - lat) * here.north);
    ++(off.norm() < 300 ? counts.right : counts.wrong);
    counts.errors.push_back(off.norm());
    Eigen::Matrix2d covariance;
    covariance << row.at("var_x"), row.at("cov_xy"), row.at("cov_xy"), row.at("var_y");
    counts.nees.push_back(off.dot(covariance.inverse() * off) / 2);
    std::cout << lon << " " << lat << ": off " << off.norm() << " m, sd " << std::sqrt(covariance.trace())
              << "; " << result["wrong_probability"] << "\n";
    EXPECT_LT(double(result["wrong_probability"]), 1e-3);
  }
  std::ranges::sort(counts.errors);
  double nees = 0;
  for (const double n : counts.nees) nees += n / double(counts.nees.size());
  std::cout << file.filename() << ": of " << tries << " panoramas " << counts.right << " right, "
            << counts.wrong << " wrong, " << counts.unknown << " unknown; median error "
            << (counts.errors.empty() ? NAN : counts.errors[counts.errors.size() / 2]) << " m, ANEES " << nees
            << "\n";
  return counts;
}

// Panoramas that the testbed renders along a drive over hills; the DEM has cells of 2 m and errors of 0.1 m.
TEST(Panorama, OfTheTestbedIsLocated) {
  TempFolder folder;
  write_text(folder / "hills.json", R"({"waymark_scenario": 1, "name": "Hills", "seed": 52,
    "ground": {"width": 800, "height": 800, "cell": 1},
    "relief": {"rms": 12, "max_wavelength": 250, "roughness": 0.4},
    "craters": {"density": 0.01, "max_diameter": 20}, "rocks": {"k": 0.001, "min_diameter": 0.8, "max_diameter": 2},
    "dunes": {"cover": 0}, "flights": [], "dem": {"cell": 2, "height_sd": 0.1},
    "drive": {"route": "wander", "max_slope": 0.7, "length": 100, "panorama": {"on": true, "every": 60}}})");
  const std::string site = folder / "site", dem = site + "/dem.tif";
  ASSERT_EQ(waymark({"simulate", folder / "hills.json", "-o", site}).code, 0);
  ASSERT_EQ(
      waymark({"peaks", dem, "-o", folder / "summits.gpkg", "--min-prominence", "3", "--crs", "local"}).code,
      0);
  std::vector<json> panoramas, truth;
  std::istringstream log(text_of(site + "/log.jsonl"));
  for (std::string line; std::getline(log, line);) {
    const json record = json::parse(line);
    if (record["kind"] == "panorama") panoramas.push_back(record);
    if (record["kind"] == "truth") truth.push_back(record);
  }
  ASSERT_GE(panoramas.size(), 3u);
  int right = 0;
  for (const json& panorama : panoramas) {
    write_text(folder / "one.jsonl", R"({"kind":"header","version":1,"frame":"map"})"
                                     "\n" +
                                         panorama.dump() + "\n");
    const Outcome said =
        waymark({"localize", folder / "summits.gpkg", folder / "one.jsonl", "-o", folder / "track.csv",
                 "--method", "global", "--dem", dem, "--set", "eye=1.5", "--set", "summit_height_sd=0.3",
                 "--set", "summit_position_sd=2", "--format", "json"});
    ASSERT_EQ(said.code, 0) << said.err;
    const json result = json::parse(said.out);
    if (result["found_s"].is_null()) continue;
    const auto at = std::ranges::min_element(
        truth, {}, [&](const json& t) { return std::abs(double(t["t"]) - double(panorama["t"])); });
    EXPECT_LT(std::hypot(double(result["found_x_m"]) - double((*at)["x"]),
                         double(result["found_y_m"]) - double((*at)["y"])),
              2);
    EXPECT_LT(double(result["wrong_probability"]), 1e-3);
    ++right;
  }
  EXPECT_GE(right, static_cast<int>(panoramas.size()) - 1);
}

TEST(Panorama, IsLocatedInTheSampleDem) {
  const Counts c = locate_panoramas(kSource / "sample_data/jacksboro/dem.tif", 4, 711, "20");
  EXPECT_EQ(c.wrong, 0);
  EXPECT_GE(c.right, 3);
}

TEST(Panorama, IsLocatedInRealMountains) {
  if (!std::filesystem::exists(kDems)) GTEST_SKIP() << kDems << " is not on this machine";
  for (const char* tile : {"N42E001.tif", "S33W071.tif"}) {
    const Counts c = locate_panoramas(kDems / tile, 2, 712, "40");
    EXPECT_EQ(c.wrong, 0) << tile;
    EXPECT_GE(c.right, 1) << tile;
  }
}

}  // namespace
}  // namespace waymark::test
