// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localize_method.hpp"

namespace waymark::workflows {
namespace {

class Odometry final : public FilterMethod {
 public:
  std::string_view name() const override { return "odometry"; }
  std::string_view summary() const override { return "dead reckoning alone, the baseline of the others"; }
  bool requires_map() const override { return false; }
  SettingGroups groups() const override { return SettingGroups::without_matching(); }

  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override {
    return std::make_unique<localization::DeadReckoning>(*task.start);
  }
};

}  // namespace

void register_method_odometry(MethodTable& methods);
void register_method_odometry(MethodTable& methods) {
  methods.add<Odometry>();
}

}  // namespace waymark::workflows
