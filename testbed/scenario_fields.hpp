// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>
#include "core/options.hpp"
namespace waymark {

/// What visits the fields of one object of a scenario file.
using FieldsOf = std::function<void(OptionVisitor&)>;

/// Sets the fields that a JSON object gives. `place` is its path in the file, for messages; `also`: names in
/// it that are no fields. Throws Error{usage} for names that are unknown, values out of range or of the wrong
/// kind.
void read_fields(const FieldsOf& describe, std::string_view json, const std::string& place,
                 const std::string& source, const std::vector<std::string>& also = {});

/// All fields with their values, as a JSON object.
std::string written_fields(const FieldsOf& describe);

/// The `properties` of a JSON schema: kinds, defaults, units, ranges.
std::string schema_of_fields(const FieldsOf& describe);

}  // namespace waymark
