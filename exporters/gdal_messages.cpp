// SPDX-License-Identifier: Apache-2.0
#include "exporters/gdal_messages.hpp"

#include <cpl_error.h>
#include <gdal.h>

#include <algorithm>

namespace waymark::exporters {
namespace {

void collect(CPLErr severity, CPLErrorNum, const char* text) {
  auto* messages = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (severity >= CE_Failure) messages->add_failure(text);
  if (severity == CE_Warning) messages->add_warning(text);
}

void add_once(std::vector<std::string>& to, std::string text) {
  if (std::find(to.begin(), to.end(), text) == to.end()) to.push_back(std::move(text));
}

}  // namespace

GdalMessages::GdalMessages() {
  static const bool registered = (GDALAllRegister(), true);
  static_cast<void>(registered);
  CPLPushErrorHandlerEx(collect, this);
}

GdalMessages::~GdalMessages() {
  CPLPopErrorHandler();
}

std::string GdalMessages::cause(const std::string& otherwise) const {
  if (!failures_.empty()) return failures_.front();
  if (!warnings_.empty()) return warnings_.front();
  return otherwise;
}

void GdalMessages::add_failure(std::string text) {
  add_once(failures_, std::move(text));
}
void GdalMessages::add_warning(std::string text) {
  add_once(warnings_, std::move(text));
}

int stop_after_failure(double, const char*, void* messages) {
  return static_cast<const GdalMessages*>(messages)->failures().empty() ? 1 : 0;
}

}  // namespace waymark::exporters
