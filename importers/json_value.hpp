// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace waymark::importers {

/// A value of a JSON file with its location, so that every error names the file and the JSON path. Access to
/// a missing member or one of another kind throws Error{input}.
class JsonValue {
 public:
  /// Reads a file, `/vsi` paths included. Skips members named in `skipped` at any depth while reading, such
  /// as point clouds of gigabytes.
  static JsonValue from_file(const std::string& path, const std::vector<std::string>& skipped = {});
  /// Reads a text; errors name `path`.
  static JsonValue from_text(const std::string& content, const std::string& path,
                             const std::vector<std::string>& skipped = {});

  bool is_object() const;
  bool is_array() const;
  bool is_text() const;
  bool is_number() const;

  bool has(const std::string& key) const;  ///< false for a missing or null member
  JsonValue operator[](const std::string& key) const;
  JsonValue operator[](std::size_t index) const;
  std::size_t size() const;
  std::vector<std::string> keys() const;

  double number() const;  ///< finite
  double number(const std::string& key, double otherwise) const;
  std::int64_t integer() const;
  std::string text() const;
  std::vector<double> numbers() const;
  Eigen::Vector3d vector3() const;
  /// Returns a matrix given as rows of numbers, or as one array row by row.
  Eigen::Matrix3d matrix3() const;

  /// Throws Error{input} for a member that is not in `known`, with the nearest name.
  void expect_only(const std::vector<std::string>& known) const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& hint = {}) const;
  const std::string& location() const { return location_; }  ///< "/images/3/centre"

 private:
  struct Document;
  JsonValue(std::shared_ptr<const Document> document, const void* value, std::string location)
      : document_(std::move(document)), value_(value), location_(std::move(location)) {}

  std::shared_ptr<const Document> document_;
  const void* value_;
  std::string location_;
};

/// Returns the first bytes of a file, `/vsi` paths included; fewer if the file is shorter. Throws
/// Error{input} if it cannot be read.
std::string read_vsi_head(const std::string& path, std::size_t bytes = 4096);

/// Returns the whole file. Throws Error{input} if it cannot be read.
std::string read_vsi_text(const std::string& path);

}  // namespace waymark::importers
