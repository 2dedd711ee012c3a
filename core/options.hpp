// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>
#include "core/units.hpp"
namespace waymark::inline core {

/// Declaration of an option; source of its help, JSON schema, Markdown, range check and canonical form.
struct Field {
  std::string help;  ///< the effect, not the name: "Smallest rock kept"
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  ///< of a text option; empty: any text
  bool affects_result = true;             ///< false: excluded from fingerprints (threads, memory)
  std::string formerly = {};              ///< earlier name, still read, with a warning; empty: none
};

/// Visitor of the options of a stage, in the order of declaration. The Options of a stage define
///   void describe(OptionVisitor& option) { option("min_height", min_height, {.help = "...", .min = 0}); }
/// The class is abstract rather than a template, so that a stage compiles without JSON.
class OptionVisitor {
 public:
  virtual ~OptionVisitor() = default;

  template <class Unit>
  void operator()(std::string_view name, Quantity<Unit>& value, const Field& field) {
    number(name, value.value, Unit::symbol, field);
  }
  void operator()(std::string_view name, double& value, const Field& field) {
    number(name, value, "", field);
  }
  void operator()(std::string_view name, std::int64_t& value, const Field& field) {
    integer(name, value, field);
  }
  void operator()(std::string_view name, bool& value, const Field& field) { flag(name, value, field); }
  void operator()(std::string_view name, std::string& value, const Field& field) { text(name, value, field); }
  void operator()(std::string_view name, std::vector<std::string>& value, const Field& field) {
    texts(name, value, field);
  }

 protected:
  virtual void number(std::string_view name, double& value, std::string_view unit, const Field&) = 0;
  virtual void integer(std::string_view name, std::int64_t& value, const Field&) = 0;
  virtual void flag(std::string_view name, bool& value, const Field&) = 0;
  virtual void text(std::string_view name, std::string& value, const Field&) = 0;
  virtual void texts(std::string_view name, std::vector<std::string>& value, const Field&) = 0;
};

}  // namespace waymark::inline core
