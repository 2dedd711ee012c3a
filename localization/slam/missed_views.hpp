// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <vector>
#include "landmarks/landmark_type.hpp"
namespace waymark::localization {

/// What missed detections say about landmarks of a map, with rates learnt from those that were seen.
/// - A view is all looks from places within half of the range of its first look. Misses of different views
///   are nearly independent. Its bin: sensor, landmark type, half octave of range.
/// - A fraction w of existing landmarks is never visible from a bin. Another one is missed there in each view
///   with probability m: n missed views have the probability w + (1 - w) m^n.
/// - w = (I + 1/2) / (I + V + 1) counts landmarks that were matched in this drive: V were seen in the bin, I
///   were not. m likewise counts views of the V landmarks (Jeffreys' prior for both).
class MissedViews {
 public:
  explicit MissedViews(std::size_t landmarks = 0) : landmarks_(landmarks) {}

  struct Look {
    std::size_t landmark = 0;
    int source = 0;  ///< kind of sensor
    std::optional<TypeId> type = {};
    Eigen::Vector2d sensor = Eigen::Vector2d::Zero();
    double range = 1;  ///< m
    bool is_seen = false;
  };
  /// Adds a look at a landmark that the sensor might show.
  void add(const Look& look);
  /// Notes that a landmark was matched: it exists, and the views that missed it before are no evidence.
  void note_match(std::size_t landmark);
  /// Returns the log likelihood, <= 0, of the views that missed a landmark since its last match.
  double evidence(std::size_t landmark) const;
  /// Returns the fraction of looks in the bin of `look` that show a landmark which exists; 1/2 if unknown.
  double detection(const Look& look) const;
  /// Returns the largest such fraction of the bins with twenty looks or more; 1 if there is none.
  double best_detection() const;
  /// Forgets the missed views of all landmarks; rates stay.
  void forget_views();

 private:
  struct Bin {
    double visible = 0, invisible = 0;  ///< landmarks: V and I
    double views = 0, missed = 0;       ///< of visible landmarks
    double looks = 0, hits = 0;         ///< of landmarks that were matched
  };
  struct History {  ///< of a landmark in a bin
    std::size_t bin = 0;
    int views = 0, missed = 0, looks = 0, hits = 0;
    int missed_since_match = 0;
  };
  struct View {
    int source = 0;
    std::size_t history = 0;
    Eigen::Vector2d from = Eigen::Vector2d::Zero();
    double range = 0;
    int looks = 0;
    bool is_seen = false, is_counted = false;
  };
  struct Landmark {
    bool exists = false;
    std::vector<History> histories;
    std::vector<View> views;  ///< the last one of each source
  };
  using Key = std::tuple<int, std::size_t, int>;
  static Key key_of(const Look& look);
  std::size_t bin_of(const Look& look);
  View& view_of(Landmark& landmark, const Look& look);
  static void count(View& view, History& history);
  void credit(const History& history, double sign);

  std::map<Key, std::size_t> index_;
  std::vector<Bin> bins_;
  std::vector<Landmark> landmarks_;
};

}  // namespace waymark::localization
