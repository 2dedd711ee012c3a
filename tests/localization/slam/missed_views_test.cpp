// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/missed_views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace waymark::test {
using namespace localization;
namespace {

using Look = MissedViews::Look;

// Looks from one place; views from different places, 10 m apart, at a range of 6 m.
void view(MissedViews& missed, std::size_t landmark, int place, bool is_seen, double range = 6) {
  for (int i = 0; i < 3; ++i)
    missed.add({.landmark = landmark, .sensor = {10.0 * place, 0}, .range = range, .is_seen = is_seen});
  if (is_seen) missed.note_match(landmark);
}

TEST(MissedViews, LooksFromOnePlaceAreOneView) {
  MissedViews missed(1);
  view(missed, 0, 0, false);
  const double once = missed.evidence(0);
  EXPECT_DOUBLE_EQ(once, std::log(0.5 + 0.5 * 0.5));  // nothing known: w = m = 1/2
  for (int i = 0; i < 50; ++i) view(missed, 0, 0, false);
  EXPECT_DOUBLE_EQ(missed.evidence(0), once);
  view(missed, 0, 1, false);
  EXPECT_DOUBLE_EQ(missed.evidence(0), std::log(0.5 + 0.5 * 0.25));
}

TEST(MissedViews, AMissSaysMuchWhereAllOthersAreVisibleAndNothingWhereNoneIs) {
  MissedViews missed(21);
  for (std::size_t l = 0; l < 20; ++l) view(missed, l, 0, true, 6), view(missed, l, 1, false, 20);
  for (std::size_t l = 0; l < 20; ++l)
    EXPECT_NEAR(missed.evidence(l), std::log(20.5 / 21 + 0.25 / 21), 1e-12);
  view(missed, 20, 0, false, 20);
  EXPECT_GT(missed.evidence(20), -0.05);
  view(missed, 20, 2, false, 6);                   // 20 m on: another view
  EXPECT_LT(missed.evidence(20), std::log(0.05));  // 0.024 + 0.976 * 0.024
}

TEST(MissedViews, AMatchTakesBackWhatMissesSaid) {
  MissedViews missed(1);
  for (int place = 0; place < 4; ++place) view(missed, 0, place, false);
  EXPECT_LT(missed.evidence(0), -0.5);
  view(missed, 0, 5, true);
  EXPECT_DOUBLE_EQ(missed.evidence(0), 0);
}

/// Keeps every look and counts all again.
class SlowMissedViews {
 public:
  void add(const Look& look) { events_.push_back(look); }
  void note_match(std::size_t landmark) { events_.push_back({.landmark = landmark, .source = -1}); }
  double evidence(std::size_t landmark) const {
    double sum = 0;
    for (int bin = -10; bin < 20; ++bin) {
      for (int source = 0; source < 2; ++source) {
        double visible = 0, invisible = 0, views = 0, missed = 0, own = 0;
        for (std::size_t l = 0; l < 8; ++l) {
          const Count c = count(l, source, bin);
          if (l == landmark) own = c.since_match;
          if (!c.exists) continue;
          if (c.seen)
            ++visible, views += c.views, missed += c.missed;
          else
            invisible += c.missed > 0;
        }
        const double w = (invisible + 0.5) / (visible + invisible + 1), m = (missed + 0.5) / (views + 1);
        if (own > 0) sum += std::log(w + (1 - w) * std::pow(m, own));
      }
    }
    return sum;
  }

 private:
  struct Count {
    bool exists = false, seen = false;
    double views = 0, missed = 0, since_match = 0;
  };
  Count count(std::size_t landmark, int source, int bin) const {
    Count c;
    std::vector<std::vector<Look>> all;  // the views of the source
    std::vector<double> open;            // index of the views that the last match left out
    std::size_t matched_at = 0;          // looks before the last match
    for (const Look& look : events_) {
      if (look.landmark != landmark) continue;
      if (look.source < 0) {
        c.exists = true;
        matched_at = all.empty() ? 0 : all.size() - (counts(all, all.size() - 1) ? 0 : 1);
      } else if (look.source == source) {
        if (all.empty() || (look.sensor - all.back()[0].sensor).norm() > 0.5 * all.back()[0].range)
          all.emplace_back();
        all.back().push_back(look);
      }
    }
    for (std::size_t v = 0; v < all.size(); ++v) {
      if (static_cast<int>(std::floor(2 * std::log2(all[v][0].range))) != bin || !counts(all, v)) continue;
      ++c.views;
      c.seen = c.seen || is_seen(all[v]);
      if (is_seen(all[v])) continue;
      ++c.missed;
      c.since_match += v >= matched_at;
    }
    return c;
  }
  static bool is_seen(const std::vector<Look>& view) {
    for (const Look& look : view)
      if (look.is_seen) return true;
    return false;
  }
  // Over, long enough, or seen.
  static bool counts(const std::vector<std::vector<Look>>& all, std::size_t v) {
    return v + 1 < all.size() || all[v].size() >= 3 || is_seen(all[v]);
  }
  std::vector<Look> events_;
};

TEST(MissedViews, IsTheSlowTwin) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 bits(seed);
    const auto uniform = [&] { return double(bits()) / double(std::mt19937::max()); };
    MissedViews fast(8);
    SlowMissedViews slow;
    Eigen::Vector2d sensor(0, 0);
    for (int i = 0; i < 60; ++i) {
      sensor.x() += 2 * uniform();
      for (std::size_t l = 0; l < 8; ++l) {
        const double range = std::hypot(sensor.x() - 7.0 * double(l), 4.0);
        if (range > 20) continue;
        const bool is_seen = l < 6 && uniform() < 4 / range;
        if (is_seen) fast.note_match(l), slow.note_match(l);
        const Look look{.landmark = l, .source = i % 2, .sensor = sensor, .range = range, .is_seen = is_seen};
        fast.add(look), slow.add(look);
      }
      if (i % 10) continue;
      for (std::size_t l = 0; l < 8; ++l)
        ASSERT_NEAR(fast.evidence(l), slow.evidence(l), 1e-9) << "seed " << seed << ", set " << i;
    }
  }
}

}  // namespace
}  // namespace waymark::test
