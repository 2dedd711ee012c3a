// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Ukf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ukf"; }
  std::string_view summary() const override { return "unscented Kalman filter, square root form"; }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    return std::make_unique<UnscentedKalman>(*task.start, std::move(task.map.window),
                                             FeatureScales(task.map.map.types()),
                                             task.settings.identification, task.settings.kalman);
  }
};

}  // namespace

void register_method_ukf(MethodTable& methods);
void register_method_ukf(MethodTable& methods) {
  methods.add<Ukf>();
}

}  // namespace waymark
