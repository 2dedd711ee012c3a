// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Global final : public FilterMethod {
 public:
  std::string_view name() const override { return "global"; }
  std::string_view summary() const override { return "pf that is told no start"; }
  StartNeed start() const override { return StartNeed::ignored; }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    return std::make_unique<ParticleFilter>(std::nullopt, std::move(task.map.window),
                                            FeatureScales(task.map.map.types()), task.settings.identification,
                                            task.settings.particles);
  }
};

}  // namespace

void register_method_global(MethodTable& methods);
void register_method_global(MethodTable& methods) {
  methods.add<Global>();
}

}  // namespace waymark
