// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"
#include "localization/filters/restarting.hpp"

namespace waymark {
namespace {

class Ukf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ukf"; }
  std::string_view summary() const override {
    return "unscented Kalman filter, square root form; without identities a sum of Gaussians, as ekf";
  }

  void describe(OptionVisitor& option) override { search_.describe(option); }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    const auto begin = [window = std::move(task.map.window), scales = FeatureScales(task.map.map.types()),
                        &settings = task.settings, visible = sight_of(task),
                        growth = search_growth(task, task.settings.kalman.search_growth)](
                           const PoseEstimate& start) -> std::unique_ptr<Localizer> {
      const IdentificationOptions& id = settings.identification;
      if (id.use_identities || id.association != "joint") {
        KalmanOptions options = settings.kalman;
        options.search_growth = growth;
        return std::make_unique<UnscentedKalman>(start, window, scales, id, options);
      }
      HypothesesOptions options = settings.hypotheses;
      options.unscented = true;
      options.search_growth = growth;
      auto filter = std::make_unique<HypothesesFilter>(start, window, scales, id, options);
      filter->expect_landmarks(settings.particles.weight, visible);
      return filter;
    };
    return std::make_unique<Restarting>(*task.start, begin, finder_for(task, search_));
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_ukf(MethodTable& methods);
void register_method_ukf(MethodTable& methods) {
  methods.add<Ukf>();
}

}  // namespace waymark
