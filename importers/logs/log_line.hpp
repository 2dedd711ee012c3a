// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "localization/pose2.hpp"
namespace waymark::importers {

/// One line of a log, or an object within it, with checked values. Throws Error{input} with file and line.
class LogLine {
 public:
  /// `file` must outlive it.
  LogLine(const std::filesystem::path& file, std::size_t number, std::string_view text);

  bool has(const char* key) const;  ///< false for a missing or null member
  bool is_object(const char* key) const;
  std::vector<std::string> keys() const;
  LogLine part(const char* key) const;
  std::vector<LogLine> parts(const char* key) const;  ///< of a list

  double number(const char* key) const;
  double number(const char* key, double otherwise) const { return has(key) ? number(key) : otherwise; }
  double positive(const char* key, double otherwise) const;
  double not_negative(const char* key) const;  ///< 0 if it is missing
  /// Returns an angle in radians. Throws if it exceeds two turns, which suggests degrees.
  double angle(const char* key, std::optional<double> otherwise = {}) const;
  /// Returns a rate in rad/s. Throws if it exceeds two turns per second, which suggests degrees.
  double angular_rate(const char* key) const;
  /// Returns numbers; `otherwise` replaces null.
  std::vector<float> numbers(const char* key, float otherwise) const;
  std::string text(const char* key) const;
  localization::Pose2 pose() const;
  localization::Pose2 mount() const;

  const std::filesystem::path& file() const { return file_; }
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  LogLine(const LogLine& whole, const void* object)
      : file_(whole.file_), number_(whole.number_), document_(whole.document_), object_(object) {}
  double expect_within_two_turns(const char* key, double value, const char* rule) const;

  const std::filesystem::path& file_;
  std::size_t number_;
  std::shared_ptr<const void> document_;
  const void* object_;  ///< within the document; opaque, so that users do not include the JSON library
};

}  // namespace waymark::importers
