// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

namespace waymark::workflows {
namespace {

class Ukf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ukf"; }
  std::string_view summary() const override {
    return "unscented Kalman filter, square root form; without identities a sum of Gaussians, as ekf";
  }
  StartPolicy start() const override { return StartPolicy::required_or_none; }
  SettingGroups groups() const override { return {.particles = false}; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override {
    return make_kalman_localizer(task, search_, true);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_ukf(MethodTable& methods);
void register_method_ukf(MethodTable& methods) {
  methods.add<Ukf>();
}

}  // namespace waymark::workflows
