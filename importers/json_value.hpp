// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
namespace waymark {

/// A value of a JSON file that knows its place, so that every complaint names file and JSON path. Asking for
/// what is not there or of another kind throws Error{input}.
class JsonValue {
 public:
  /// Reads a file, `/vsi` paths too. Members named `skipped`, at any depth, are left out while reading: point
  /// clouds of gigabytes.
  static JsonValue from_file(const std::string& path, const std::vector<std::string>& skipped = {});

  bool is_object() const;
  bool is_array() const;
  bool is_text() const;
  bool is_number() const;

  bool has(const std::string& key) const;  ///< and it is not null
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
  /// Rows of numbers, or all in one array row by row.
  Eigen::Matrix3d matrix3() const;

  /// Refuses members that are not in `known`, naming the nearest that is.
  void expect_only(const std::vector<std::string>& known) const;
  [[noreturn]] void refuse(const std::string& problem, const std::string& hint = {}) const;
  const std::string& place() const { return place_; }  ///< "/images/3/centre"

 private:
  struct Document;
  JsonValue(std::shared_ptr<const Document> document, const void* value, std::string place)
      : document_(std::move(document)), value_(value), place_(std::move(place)) {}

  std::shared_ptr<const Document> document_;
  const void* value_;
  std::string place_;
};

/// The first bytes of a file, `/vsi` paths too; fewer where it is shorter. Throws Error{input} where it
/// cannot be read.
std::string head_of(const std::string& path, std::size_t bytes = 4096);

/// The whole file.
std::string content_of(const std::string& path);

}  // namespace waymark
