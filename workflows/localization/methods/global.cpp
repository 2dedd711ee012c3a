// SPDX-License-Identifier: Apache-2.0
#include "workflows/localization/localizer_factory.hpp"

namespace waymark::workflows {
namespace {

class Global final : public FilterMethod {
 public:
  std::string_view name() const override { return "global"; }
  std::string_view summary() const override {
    return "particle filter without a start: constellations of landmarks, and with --dem skylines, propose "
           "poses";
  }
  StartPolicy start() const override { return StartPolicy::ignored; }
  SettingGroups groups() const override { return {.kalman = false, .start = false}; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

  std::unique_ptr<localization::Localizer> make(LocalizeTask& task) const override {
    return make_particle_localizer(task, std::nullopt, search_);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_global(MethodTable& methods);
void register_method_global(MethodTable& methods) {
  methods.add<Global>();
}

}  // namespace waymark::workflows
