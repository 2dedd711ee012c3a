// SPDX-License-Identifier: Apache-2.0
#include "apps/localize_settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/parse.hpp"
#include "core/error.hpp"

namespace waymark {
namespace {

/// Sets the one option that has a name, wherever it is declared.
class Setter final : public OptionVisitor {
 public:
  Setter(std::string name, std::string value) : name_(std::move(name)), value_(std::move(value)) {}
  bool done = false;
  std::vector<std::string> names;

 private:
  bool mine(std::string_view name) {
    names.emplace_back(name);
    return name == name_ && (done = true);
  }
  double checked(const Field& field) const {
    const double value = to_number("--set " + name_, value_);
    if (!(field.min <= value && value <= field.max))
      throw Error(ErrorCode::usage, fmt::format("--set {} must be within [{:g}, {:g}], is {}", name_,
                                                field.min, field.max, value_));
    return value;
  }
  void number(std::string_view name, double& value, std::string_view, const Field& field) override {
    if (mine(name)) value = checked(field);
  }
  void integer(std::string_view name, std::int64_t& value, const Field& field) override {
    if (!mine(name)) return;
    const double number = checked(field);
    if (number != std::floor(number) || std::abs(number) > 1e15)
      throw Error(ErrorCode::usage, "--set " + name_ + " must be a whole number, is " + value_);
    value = static_cast<std::int64_t>(number);
  }
  void flag(std::string_view name, bool& value, const Field&) override {
    if (!mine(name)) return;
    if (value_ != "true" && value_ != "false")
      throw Error(ErrorCode::usage, "--set " + name_ + " must be true or false, is " + value_);
    value = value_ == "true";
  }
  void text(std::string_view name, std::string& value, const Field& field) override {
    if (!mine(name)) return;
    if (!field.choices.empty() && std::ranges::find(field.choices, value_) == field.choices.end())
      throw Error(ErrorCode::usage, fmt::format("--set {} must be one of {}, is '{}'", name_,
                                                fmt::join(field.choices, ", "), value_));
    value = value_;
  }
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}

  std::string name_, value_;
};

class Lister final : public OptionVisitor {
 public:
  std::string text_of_all;

 private:
  void add(std::string_view name, const std::string& value, const Field& field) {
    text_of_all += fmt::format("{}={}  {}\n", name, value, field.help);
  }
  void number(std::string_view n, double& v, std::string_view, const Field& f) override {
    add(n, fmt::format("{:g}", v), f);
  }
  void integer(std::string_view n, std::int64_t& v, const Field& f) override {
    add(n, fmt::format("{}", v), f);
  }
  void flag(std::string_view n, bool& v, const Field& f) override { add(n, v ? "true" : "false", f); }
  void text(std::string_view n, std::string& v, const Field& f) override { add(n, v, f); }
  void texts(std::string_view, std::vector<std::string>&, const Field&) override {}
};

}  // namespace

void LocalizeSettings::describe(OptionVisitor& option) {
  identification.describe(option);
  kalman.describe(option);
  hypotheses.describe(option);
  particles.describe(option);
  play.describe(option);
  scans.describe(option);
  sight.describe(option);
  option("start_sd", start_sd, {.help = "Metres by which the start may be off", .min = 1e-6, .max = 1e6});
  option("start_yaw_sd", start_yaw_sd,
         {.help = "Radians by which the heading of the start may be off", .min = 1e-6, .max = 4});
}

void set_option(const DescribeOptions& describe, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw Error(ErrorCode::usage, "--set takes OPTION=VALUE, is '" + setting + "'", "",
                "e.g. --set particles=1000");
  const std::string name = setting.substr(0, equals);
  Setter setter(name, setting.substr(equals + 1));
  describe(setter);
  if (setter.done) return;
  const std::string near = nearest_name(name, setter.names);
  throw Error(ErrorCode::usage, "localize has no option '" + name + "'", "",
              near.empty() ? fmt::format("options: {}", fmt::join(setter.names, ", "))
                           : "did you mean '" + near + "'?");
}

std::string options_as_text(const DescribeOptions& describe) {
  Lister lister;
  describe(lister);
  return lister.text_of_all;
}

}  // namespace waymark
