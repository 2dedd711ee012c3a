// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/isolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "core/error.hpp"
#include "pipeline/terrain/contact.hpp"
#include "pipeline/terrain/nearest_grid_point.hpp"
#include "tests/pipeline/terrain/survey.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

std::vector<HighPoint> summits_of(const DemSource& dem) {
  std::vector<HighPoint> points;
  for (const Summit& s : survey(dem, 1 << 20, 0, BasePolicy::none)) points.push_back({s.cell, s.height});
  return points;
}

// ---- the slow twin: look at every cell
// -------------------------------------------------------------------------

template <class Metric>
Isolation by_looking_everywhere(const HighPoint& summit, const MemoryDem& dem, const Metric& metric) {
  const GridGeometry& grid = dem.geometry();
  const GridPoint here{static_cast<double>(summit.cell % grid.columns),
                       static_cast<double>(summit.cell / grid.columns)};
  Isolation best;
  const auto at_most = [](std::optional<double>& value, double other) {
    value = std::min(value.value_or(other), other);
  };
  std::optional<double> hidden;
  for (std::int64_t r = -1; r <= grid.rows; ++r)
    for (std::int64_t c = -1; c <= grid.columns; ++c) {
      const GridPoint there{static_cast<double>(c), static_cast<double>(r)};
      if (grid.wraps && (c < 0 || c >= grid.columns)) continue;
      if (dem.heights().contains(c, r) && dem.heights()(c, r) > summit.height) {
        const double metres = metric.distance(here, there);
        if (!best.metres || metres < *best.metres) best = {metres, {}, there};
      } else if (!dem.heights().contains(c, r)) {
        if ((r < 0 && grid.north_pole) || (r >= grid.rows && grid.south_pole)) continue;
        at_most(hidden, metric.distance(here, there));
      } else if (dem.heights()(c, r) == kNoHeight && dem.nodata_policy() != NodataPolicy::ocean) {
        at_most(hidden, metric.distance(here, there));
      }
    }
  best.metres_low = best.metres;
  if (hidden) at_most(best.metres_low, *hidden);
  return best;
}

template <class Metric>
void expect_agreement(const MemoryDem& dem, const Metric& metric, const IsolationOptions& options) {
  const auto summits = summits_of(dem);
  const auto fast = measure_isolation(summits, dem, pyramid_of(dem, 23), options);
  ASSERT_EQ(fast.size(), summits.size());
  for (std::size_t i = 0; i < summits.size(); ++i) {
    const Isolation slow = by_looking_everywhere(summits[i], dem, metric);
    ASSERT_EQ(fast[i].metres.has_value(), slow.metres.has_value()) << i;
    ASSERT_EQ(fast[i].metres_low.has_value(), slow.metres_low.has_value()) << i;
    if (slow.metres) {
      ASSERT_NEAR(*fast[i].metres, *slow.metres, 1e-9 * *slow.metres) << "summit " << i;
    }
    if (slow.metres_low) {
      ASSERT_NEAR(*fast[i].metres_low, *slow.metres_low, 1e-9 * *slow.metres_low) << "summit " << i;
    }
  }
}

const Georeference kAlps{Crs::from_text("EPSG:4326"), 8.0, 47.0, 1 / 1200.0, -1 / 1200.0};

TEST(Isolation, EndsAtTheNearestHigherCell) {
  const MemoryDem dem(dem_art("0 0 0 0 0 / 0 5 0 0 6 / 0 0 0 0 0 / 0 9 0 0 0"));
  const auto isolation =
      measure_isolation(summits_of(dem), dem, pyramid_of(dem, 2), {.distance = DistanceKind::planar});
  EXPECT_FALSE(isolation[0].metres);
  EXPECT_NEAR(*isolation[1].metres, std::sqrt(9 + 4), 1e-12);  // 6 -> 9
  EXPECT_NEAR(*isolation[2].metres, 2, 1e-12);                 // 5 -> 9, not 6
  EXPECT_EQ(isolation[2].higher.column, 1);
  EXPECT_EQ(isolation[2].higher.row, 3);
}

TEST(Isolation, HiddenGroundBoundsItFromBelow) {
  const MemoryDem dem(dem_art("0 0 0 0 0 0 0 0 / 0 0 5 0 0 0 0 9 / 0 0 0 0 0 0 0 0"));
  const auto isolation = measure_isolation(summits_of(dem), dem, pyramid_of(dem, 3), {});
  EXPECT_NEAR(*isolation[1].metres, 5, 1e-12);
  EXPECT_NEAR(*isolation[1].metres_low, 2, 1e-12);  // the row above the map
  EXPECT_NEAR(*isolation[0].metres_low, 1, 1e-12);
}

TEST(Isolation, AVoidBoundsItUnlessItIsOcean) {
  const auto art = dem_art(
      "0 0 0 0 0 0 0 / 0 0 0 0 0 0 0 / 0 0 0 0 0 0 0 / 0 0 0 5 . 0 9 / 0 0 0 0 0 0 0 / 0 0 0 0 0 0 0");
  const MemoryDem ocean(art), unknown(art, {}, NodataPolicy::unknown);
  EXPECT_NEAR(*measure_isolation(summits_of(ocean), ocean, pyramid_of(ocean, 4), {})[1].metres_low, 3, 1e-12);
  EXPECT_NEAR(*measure_isolation(summits_of(unknown), unknown, pyramid_of(unknown, 4), {})[1].metres_low, 1,
              1e-12);
}

TEST(Isolation, AVoidInTheMountainsIsNoSea) {
  const auto art = dem_art(
      "0 0 0 0 0 0 0 / 0 0 0 0 0 0 0 / 0 0 0 0 0 0 0 / 0 0 0 500 . 0 900 / 0 0 0 0 0 0 0 / 0 0 0 0 0 0 0");
  const MemoryDem dem(art);
  EXPECT_NEAR(*measure_isolation(summits_of(dem), dem, pyramid_of(dem, 4), {})[1].metres_low, 1, 1e-12);
}

TEST(Isolation, ContactIsTheInterpolatedPointOfEqualElevation) {
  const MemoryDem dem(dem_art("0 0 0 0 0 0 / 0 6 0 0 0 9 / 0 0 0 0 0 0"));
  const auto contact =
      measure_isolation(summits_of(dem), dem, pyramid_of(dem, 64), {.end = IsolationEnd::contact});
  EXPECT_NEAR(*contact[1].metres, 4 - 3 / 9.0, 1e-12);  // the slope from 9 down to 0 passes 6
  EXPECT_NEAR(contact[1].higher.column, 5 - 3 / 9.0, 1e-12);
}

TEST(Isolation, PlanarDistancesNeedAProjectedMap) {
  const MemoryDem dem(dem_art("0 0 / 0 1"), kAlps);
  try {
    measure_isolation(summits_of(dem), dem, pyramid_of(dem, 4), {.distance = DistanceKind::planar});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("EPSG:4326"), std::string::npos) << error.what();
  }
}

TEST(Isolation, MatchesTheTwinInDegrees) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto policy = seed % 2 ? NodataPolicy::unknown : NodataPolicy::ocean;
    Georeference where = kAlps;
    where.y0 = 20.0 * (seed % 5) - 40;
    const MemoryDem dem(random_terrain(seed, 40 + seed, 33), where, policy);
    ASSERT_NO_FATAL_FAILURE(expect_agreement(dem, GeographicMetric(dem.geometry()), {}));
  }
}

TEST(Isolation, MatchesTheTwinRoundAWholeBody) {
  for (const char* crs : {"EPSG:4326", "IAU_2015:49900", "+proj=longlat +a=3396190 +b=3000000 +no_defs"}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(crs + std::string(" seed ") + std::to_string(seed));
      const Georeference where{Crs::from_text(crs), 2.5, 87.5, 5, -5};
      const MemoryDem dem(random_terrain(seed + 8, 72, 36), where, NodataPolicy::unknown, true, true);
      ASSERT_NO_FATAL_FAILURE(expect_agreement(dem, GeographicMetric(dem.geometry()), {}));
    }
  }
}

TEST(Isolation, MatchesTheTwinOnProjectedGrids) {
  for (const char* crs : {"EPSG:32611", "EPSG:3413", "EPSG:3857"}) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      SCOPED_TRACE(crs + std::string(" seed ") + std::to_string(seed));
      const double cell = seed % 2 ? 30 : 4000;
      const Georeference where{Crs::from_text(crs), 500000, 4000000, cell, -cell};
      const MemoryDem dem(random_terrain(seed, 61, 47), where, NodataPolicy::unknown);
      ASSERT_NO_FATAL_FAILURE(expect_agreement(dem, ProjectedMetric(dem.geometry()), {}));
      ASSERT_NO_FATAL_FAILURE(
          expect_agreement(dem, PlanarMetric(dem.geometry()), {.distance = DistanceKind::planar}));
    }
  }
}

// Every summit asks for it. Setting up the metric transforms the lattice; rescanning it 20,000 times would
// take a hundred times as long.
TEST(ProjectedMetric, CellDiagonalDoesNotRescanTheGrid) {
  const auto seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  const GridGeometry grid{
      .columns = 6000, .rows = 6000, .where = {Crs::from_text("EPSG:32632"), 300000, 5400000, 30, -30}};
  const double begin = seconds();
  const ProjectedMetric metric(grid);
  const double made = seconds();
  double sum = 0;
  for (int i = 0; i < 20000; ++i) sum += metric.cell_diagonal();
  EXPECT_LT(seconds() - made, made - begin);
  EXPECT_GT(sum / 20000, std::hypot(30, 30));  // an upper bound, wide at the extrapolated edge
  EXPECT_LT(sum / 20000, 1.6 * std::hypot(30, 30));
}

// Beyond 67 M cells the lattice is coarser, but distances stay exact and bounds stay bounds.
TEST(ProjectedMetric, HoldsOnALargeGrid) {
  const GridGeometry grid{
      .columns = 33000, .rows = 21000, .where = {Crs::from_text("EPSG:32632"), 0, 5400000, 30, -30}};
  const ProjectedMetric metric(grid);
  const Geodesic geodesic(grid.where.crs.body());
  CrsTransform to_degrees(grid.where.crs, geographic_crs(grid.where.crs));
  const auto degrees = [&](std::int64_t c, std::int64_t r) {
    const auto at = to_degrees(grid.where.x(static_cast<double>(c)), grid.where.y(static_cast<double>(r)));
    return LonLat{at.x, at.y};
  };
  const std::int64_t column = 32990, row = 14;
  const auto origin = metric.origin(column, row);
  for (const Window cells : {Window{0, 0, 16, 16}, Window{32960, 32, 16, 16}, Window{32992, 0, 8, 16},
                             Window{16384, 4096, 4096, 4096}, Window{32960, 0, 16, 16}})
    for (const std::int64_t c : {cells.column, cells.column + cells.columns / 3, cells.end_column() - 1})
      for (const std::int64_t r : {cells.row, cells.row + cells.rows / 2, cells.end_row() - 1}) {
        const double exact = geodesic.distance(degrees(column, row), degrees(c, r));
        const double straight = std::sqrt(metric.squared(origin, c, r));
        EXPECT_LE(metric.lower_bound(origin, cells), metric.squared(origin, c, r) + 1e-9);
        EXPECT_LE(straight, exact + metric.slack(exact));
        EXPECT_EQ(metric.distance({static_cast<double>(column), static_cast<double>(row)},
                                  {static_cast<double>(c), static_cast<double>(r)}),
                  exact);
      }
}

TEST(Isolation, DoesNotDependOnTiles) {
  const MemoryDem dem(random_terrain(7, 90, 70), kAlps, NodataPolicy::unknown);
  const auto summits = summits_of(dem);
  const auto whole = measure_isolation(summits, dem, pyramid_of(dem, 1000), {});
  for (const std::int64_t side : {5, 16, 33})
    EXPECT_EQ(measure_isolation(summits, dem, pyramid_of(dem, side), {}), whole);
}

TEST(Isolation, ContactIsAtMostOneDiagonalNearerThanTheCell) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MemoryDem dem(random_terrain(seed, 50, 40), kAlps);
    const auto summits = summits_of(dem);
    const auto cell = measure_isolation(summits, dem, pyramid_of(dem, 64), {});
    const auto contact = measure_isolation(summits, dem, pyramid_of(dem, 64), {.end = IsolationEnd::contact});
    const double diagonal = GeographicMetric(dem.geometry()).cell_diagonal();
    for (std::size_t i = 0; i < summits.size(); ++i) {
      ASSERT_EQ(cell[i].metres.has_value(), contact[i].metres.has_value());
      if (!cell[i].metres) continue;
      EXPECT_LE(*contact[i].metres, *cell[i].metres + 1e-6);
      EXPECT_GE(*contact[i].metres, *cell[i].metres - diagonal);
    }
  }
}

// Slow twin of the contact search: contours around every higher cell.
TEST(Isolation, ContactMatchesLookingEverywhere) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const MemoryDem dem(random_terrain(seed, 30, 25), kAlps);
    const GeographicMetric metric(dem.geometry());
    const auto height = [&](std::int64_t c, std::int64_t r) {
      return dem.heights().contains(c, r) ? dem.heights()(c, r) : kNoHeight;
    };
    const auto summits = summits_of(dem);
    const auto fast = measure_isolation(summits, dem, pyramid_of(dem, 64), {.end = IsolationEnd::contact});
    for (std::size_t i = 0; i < summits.size(); ++i) {
      const GridPoint here{static_cast<double>(summits[i].cell % 30),
                           static_cast<double>(summits[i].cell / 30)};
      NearestGridPoint<GeographicMetric> nearest(metric, here);
      for (std::int64_t r = 0; r < 25; ++r)
        for (std::int64_t c = 0; c < 30; ++c)
          if (height(c, r) > summits[i].height)
            offer_contacts(metric, metric.position(here), summits[i].height, c, r, height, nearest);
      const auto slow = nearest.resolve();
      ASSERT_EQ(fast[i].metres.has_value(), slow.has_value());
      if (!slow) continue;
      EXPECT_NEAR(*fast[i].metres, slow->metres, 1e-6);
    }
  }
}

}  // namespace
}  // namespace waymark::test
