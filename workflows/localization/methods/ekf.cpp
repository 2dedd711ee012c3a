// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

namespace waymark::workflows {
namespace {

class Ekf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ekf"; }
  std::string_view summary() const override {
    return "extended Kalman filter; without identities a sum of Gaussians, one per probable data "
           "association";
  }
  StartPolicy start() const override { return StartPolicy::required_or_none; }
  SettingGroups groups() const override { return {.particles = false}; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override {
    return make_kalman_localizer(task, search_, false);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_ekf(MethodTable& methods);
void register_method_ekf(MethodTable& methods) {
  methods.add<Ekf>();
}

}  // namespace waymark::workflows
