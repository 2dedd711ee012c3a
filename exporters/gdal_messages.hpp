// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark::exporters {

/// Collects the messages of GDAL on this thread while the object lives, and keeps them off standard error.
/// Objects nest like scopes. The first one registers the drivers.
class GdalMessages {
 public:
  GdalMessages();
  ~GdalMessages();
  GdalMessages(const GdalMessages&) = delete;
  GdalMessages& operator=(const GdalMessages&) = delete;

  const std::vector<std::string>& failures() const { return failures_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Returns the first failure, which names the cause of the others; else the first warning; else
  /// `otherwise`.
  std::string cause(const std::string& otherwise) const;

  void add_failure(std::string text);
  void add_warning(std::string text);

 private:
  std::vector<std::string> failures_, warnings_;
};

/// Progress function of GDAL that stops it after the first failure; its argument is the GdalMessages. GDAL's
/// COG driver goes on with rasters that it could not write.
int stop_after_failure(double fraction, const char* text, void* messages);

}  // namespace waymark::exporters
