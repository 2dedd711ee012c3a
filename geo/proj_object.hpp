// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
struct PJconsts;  // proj.h: PJ
struct pj_ctx;    // proj.h: PJ_CONTEXT
namespace waymark {

struct ProjRelease {
  void operator()(PJconsts* object) const;
};

/// A PROJ object. It belongs to the thread that made it and must not outlive it.
using ProjObject = std::unique_ptr<PJconsts, ProjRelease>;

/// PROJ's state for one thread, offline. What PROJ has to say is kept here and never printed.
class ProjContext {
 public:
  ProjContext();
  ~ProjContext();
  ProjContext(ProjContext&&) = delete;

  pj_ctx* get() const { return context_; }
  /// PROJ's last message, without its "proj_create: " prefix; empties it.
  std::string take_message();

  /// The calling thread's own.
  static ProjContext& of_this_thread();

 private:
  pj_ctx* context_;
  std::string message_;
};

}  // namespace waymark
