// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "localization/slam/ekf_slam.hpp"
#include "workflows/localization/localizer_factory.hpp"
#include "workflows/localization/slam_update.hpp"

namespace waymark::workflows {
namespace {

class Slam final : public LocalizeMethod {
 public:
  std::string_view name() const override { return "slam"; }
  std::string_view summary() const override {
    return "robot and landmarks in one Gaussian, starting from the map or from none; --write-map and "
           "--update-map store the result";
  }
  StartPolicy start() const override { return StartPolicy::optional; }
  bool requires_map() const override { return false; }
  bool updates_map() const override { return true; }
  SettingGroups groups() const override { return {.kalman = false, .particles = false, .unseen = false}; }
  void describe(OptionVisitor& option) override {
    options_.describe(option);
    search_.describe(option);
  }

  localization::Track run(LocalizeTask& task) override {
    SlamSetup setup = slam_setup(task, options_);
    leave_out_fixes_without_start(task, setup.play);
    localization::EkfSlam slam(
        setup.start, task.map.window.landmarks_near(setup.start.pose.at(), kSlamRadius),
        localization::FeatureScales(task.map.map.types()), setup.options, line_of_sight(task));
    enable_relocalization(slam, task, search_);
    localization::Track track = run_slam(task, setup, slam);
    const std::vector<localization::SlamLandmark> landmarks = slam.landmarks();
    summarize(landmarks, setup.options, task.callbacks);
    warn_of_unplaced_ranges(task, slam.unplaced_ranges());
    write_updated_map(task, landmarks, setup.options.confirmed, name());
    return track;
  }

 private:
  static void summarize(const std::vector<localization::SlamLandmark>& landmarks,
                        const localization::SlamOptions& options, const Callbacks& callbacks) {
    std::size_t sure = 0, doubtful = 0, not_seen = 0, gone = 0;
    for (const localization::SlamLandmark& l : landmarks)
      ++(l.gone ? gone : !l.slot ? not_seen : l.log_odds >= options.confirmed ? sure : doubtful);
    callbacks.summary(
        fmt::format("landmarks: {} sure, {} doubtful, {} of the map not seen, {} of the map not there\n",
                    sure, doubtful, not_seen, gone));
  }

  localization::SlamOptions options_;
  SearchOptions search_;
};

}  // namespace

void register_method_slam(MethodTable& methods);
void register_method_slam(MethodTable& methods) {
  methods.add<Slam>();
}

}  // namespace waymark::workflows
