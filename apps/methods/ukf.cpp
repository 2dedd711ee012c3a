// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"
#include "localization/restarting.hpp"

namespace waymark {
namespace {

class Ukf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ukf"; }
  std::string_view summary() const override { return "unscented Kalman filter, square root form"; }

  void describe(OptionVisitor& option) override { search_.describe(option); }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    const auto begin = [window = std::move(task.map.window), scales = FeatureScales(task.map.map.types()),
                        &settings = task.settings](const PoseEstimate& start) -> std::unique_ptr<Localizer> {
      return std::make_unique<UnscentedKalman>(start, window, scales, settings.identification,
                                               settings.kalman);
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
