// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/sensor_profile.hpp"
#include "pipeline/engine/registry.hpp"
namespace waymark {

/// A stage, landmark type or sensor profile in the four ways `--as` asks for, from its one declaration.
struct Described {
  std::string name, summary;
  std::string text, json, schema, markdown;
};

std::vector<Described> described(const Registry& stages);
std::vector<Described> described(const TypeRegistry& types);
std::vector<Described> described(const SensorRegistry& sensors, const TypeRegistry& types);

/// Which of them to print, and how: the arguments of `waymark stages`, `types` and `sensors`.
struct DescribeWhat {
  std::string name;  ///< empty: all
  std::string as = "text";
};
std::vector<Argument> describe_arguments(DescribeWhat& what, std::vector<std::string> names);

/// To standard output. All of them are a list as text, and an object by name as json and schema. Throws
/// Error{usage} with the nearest name where there is no such `kind`.
void print_described(std::span<const Described> all, const std::string& kind, const DescribeWhat& what);

}  // namespace waymark
