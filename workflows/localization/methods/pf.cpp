// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

namespace waymark::workflows {
namespace {

class Pf final : public FilterMethod {
 public:
  std::string_view name() const override { return "pf"; }
  std::string_view summary() const override {
    return "particle filter, which finds the start if none is given";
  }
  StartPolicy start() const override { return StartPolicy::optional; }
  SettingGroups groups() const override { return {.kalman = false}; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override {
    return make_particle_localizer(task, task.start, search_);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_pf(MethodTable& methods);
void register_method_pf(MethodTable& methods) {
  methods.add<Pf>();
}

}  // namespace waymark::workflows
