// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_method.hpp"

namespace waymark {
namespace {

class Global final : public FilterMethod {
 public:
  std::string_view name() const override { return "global"; }
  std::string_view summary() const override {
    return "particles that are told no start: constellations of landmarks, and with --dem the skyline, say "
           "where they may be";
  }
  StartNeed start() const override { return StartNeed::ignored; }
  void describe(OptionVisitor& option) override { search_.describe(option); }

 protected:
  std::unique_ptr<Localizer> make(LocalizeTask& task) const override {
    return searching_particles(task, std::nullopt, search_);
  }

 private:
  SearchOptions search_;
};

}  // namespace

void register_method_global(MethodTable& methods);
void register_method_global(MethodTable& methods) {
  methods.add<Global>();
}

}  // namespace waymark
