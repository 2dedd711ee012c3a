// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Pf final : public FilterMethod {
 public:
  std::string_view name() const override { return "pf"; }
  std::string_view summary() const override { return "particles, which find the start where none is given"; }
  StartNeed start() const override { return StartNeed::found; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    return searching_particles(task, task.start, search_);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_pf(MethodTable& methods);
void register_method_pf(MethodTable& methods) {
  methods.add<Pf>();
}

}  // namespace waymark
