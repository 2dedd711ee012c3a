// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Pf final : public FilterMethod {
 public:
  std::string_view name() const override { return "pf"; }
  std::string_view summary() const override { return "particles, which find the start where none is given"; }
  StartNeed start() const override { return StartNeed::found; }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    return std::make_unique<ParticleFilter>(task.start, std::move(task.map.window),
                                            FeatureScales(task.map.map.types()), task.settings.identification,
                                            task.settings.particles);
  }
};

}  // namespace

void register_method_pf(MethodTable& methods);
void register_method_pf(MethodTable& methods) {
  methods.add<Pf>();
}

}  // namespace waymark
