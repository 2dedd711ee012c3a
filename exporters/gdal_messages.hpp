// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark {

/// Collects what GDAL says on this thread while the object lives, so that nothing reaches standard error raw.
/// They nest like scopes. GDAL's drivers are registered by the first one.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// The first failure, which names the cause of the others; else the first warning; else `otherwise`.
  std::string cause(const std::string& otherwise) const;

  void add_failure(std::string text);
  void add_warning(std::string text);

 private:
  std::vector<std::string> failures_, warnings_;
};

}  // namespace waymark
