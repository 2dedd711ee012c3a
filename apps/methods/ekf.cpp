// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Ekf final : public FilterMethod {
 public:
  std::string_view name() const override { return "ekf"; }
  std::string_view summary() const override {
    return "extended Kalman filter; without identities a sum of Gaussians, one for each way to recognise "
           "the landmarks that is still probable";
  }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    const IdentificationOptions& id = task.settings.identification;
    FeatureScales scales(task.map.map.types());
    if (!id.use_identities && id.association == "joint")
      return std::make_unique<HypothesesFilter>(*task.start, std::move(task.map.window), std::move(scales),
                                                id, task.settings.hypotheses);
    return std::make_unique<ExtendedKalman>(*task.start, std::move(task.map.window), std::move(scales), id,
                                            task.settings.kalman);
  }
};

}  // namespace

void register_method_ekf(MethodTable& methods);
void register_method_ekf(MethodTable& methods) {
  methods.add<Ekf>();
}

}  // namespace waymark
