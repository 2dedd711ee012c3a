// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
struct PJconsts;  // proj.h: PJ
struct pj_ctx;    // proj.h: PJ_CONTEXT
namespace waymark::inline geo {

struct ProjRelease {
  void operator()(PJconsts* object) const;
};

/// PROJ object. It belongs to the thread that created it and must not outlive it.
using ProjObject = std::unique_ptr<PJconsts, ProjRelease>;

/// PROJ context of one thread, without network access. Stores PROJ's last message instead of printing it.
class ProjContext {
 public:
  ProjContext();
  ~ProjContext();
  ProjContext(ProjContext&&) = delete;

  pj_ctx* get() const { return context_; }
  /// Returns PROJ's last message without its "proj_create: " prefix, and clears it.
  std::string take_message();

  /// Returns the context of the calling thread.
  static ProjContext& current();

 private:
  pj_ctx* context_;
  std::string message_;
};

}  // namespace waymark::inline geo
