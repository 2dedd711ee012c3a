// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/localize_method.hpp"
#include "apps/log.hpp"
#include "apps/slam_update.hpp"
#include "localization/slam/ekf_slam.hpp"

namespace waymark {
namespace {

class Slam final : public LocalizeMethod {
 public:
  std::string_view name() const override { return "slam"; }
  std::string_view summary() const override {
    return "robot and landmarks in one Gaussian, starting from the map or from none; --write-map and "
           "--update-map keep what was learnt";
  }
  StartNeed start() const override { return StartNeed::found; }
  bool needs_map() const override { return false; }
  bool makes_map() const override { return true; }
  void describe(OptionVisitor& option) override {
    options_.describe(option);
    search_.describe(option);
  }

  Track run(LocalizeTask& task) override {
    const SlamRun run = slam_run(task, options_);
    EkfSlam slam(run.start, task.map.window.around(run.start.pose.at(), kAround),
                 FeatureScales(task.map.map.types()), run.options, sight_of(task));
    if (task.map.map.landmarks > 0) slam.search_with(finder_for(task, search_));
    Track track = play_with(task, run, slam);
    const std::vector<SlamLandmark> landmarks = slam.landmarks();
    tell(landmarks, run.options);
    write_back(task, landmarks, run.options.confirmed, job(task, run.options));
    return track;
  }

 private:
  static void tell(const std::vector<SlamLandmark>& landmarks, const SlamOptions& options) {
    std::size_t sure = 0, doubtful = 0, unseen = 0, gone = 0;
    for (const SlamLandmark& l : landmarks)
      ++(l.gone ? gone : !l.slot ? unseen : l.log_odds >= options.confirmed ? sure : doubtful);
    say(fmt::format("landmarks: {} sure, {} doubtful, {} of the map not seen, {} of the map not there\n",
                    sure, doubtful, unseen, gone));
  }
  static std::string job(const LocalizeTask& task, const SlamOptions& o) {
    return nlohmann::json{{"method", "slam"},
                          {"log", task.log_file},
                          {"slam_match", o.match},
                          {"slam_fresh", o.fresh},
                          {"slam_nearest", o.nearest},
                          {"slam_range", o.most_range},
                          {"slam_seen", o.seen},
                          {"slam_unseen", o.unseen},
                          {"slam_confirmed", o.confirmed},
                          {"slam_dropped", o.dropped},
                          {"ids", o.use_identities ? "known" : "unknown"}}
        .dump();
  }

  SlamOptions options_;
  SearchOptions search_;
};

}  // namespace

void register_method_slam(MethodTable& methods);
void register_method_slam(MethodTable& methods) {
  methods.add<Slam>();
}

}  // namespace waymark
