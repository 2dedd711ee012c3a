// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>
namespace waymark::python {

namespace py = pybind11;

/// Keywords of a request: for each its name and the member of the request that receives it. Defaults, types
/// and signatures are made from it alone.
template <class Request>
class Keywords {
 public:
  /// Adds a keyword; `member` is a member of a request, or a function that returns a reference to one.
  template <class Member>
  Keywords& add(std::string name, Member member) {
    using Value = std::remove_cvref_t<std::invoke_result_t<Member, Request&>>;
    all_.push_back(
        {std::move(name),
         [member](Request& request, py::handle given) { set<Value>(std::invoke(member, request), given); },
         [member](Request& request) -> py::object { return object_of(std::invoke(member, request)); }});
    return *this;
  }

  /// Adds a keyword whose value of any type is kept as text: 3 as "3", true as "true".
  Keywords& add_text(std::string name, std::function<std::string&(Request&)> member) {
    all_.push_back({std::move(name),
                    [member](Request& request, py::handle given) {
                      member(request) = py::isinstance<py::bool_>(given)
                                            ? (py::cast<bool>(given) ? "true" : "false")
                                            : py::cast<std::string>(py::str(given));
                    },
                    [member](Request& request) -> py::object { return py::cast(member(request)); }});
    return *this;
  }

  bool has(const std::string& name) const {
    return std::ranges::any_of(all_, [&](const Keyword& keyword) { return keyword.name == name; });
  }

  /// Returns the request of keyword arguments. Throws TypeError for unknown names and wrong types.
  Request request(const py::dict& given) const {
    Request made;
    for (const auto& [name, value] : given) set_one(made, py::cast<std::string>(name), value);
    return made;
  }

  /// Returns the default of each keyword, in the order of declaration.
  py::dict defaults() const {
    py::dict values;
    Request unset;
    for (const Keyword& keyword : all_) values[keyword.name.c_str()] = keyword.get(unset);
    return values;
  }

 private:
  struct Keyword {
    std::string name;
    std::function<void(Request&, py::handle)> set;
    std::function<py::object(Request&)> get;
  };

  // A path is a text in Python.
  template <class Value>
  static py::object object_of(const Value& member) {
    if constexpr (std::is_same_v<Value, std::filesystem::path>)
      return py::cast(member.string());
    else
      return py::cast(member);
  }

  template <class Value>
  static void set(Value& member, py::handle given) {
    if constexpr (std::is_same_v<Value, std::vector<std::string>>) {
      if (py::isinstance<py::str>(given)) return member.assign(1, py::cast<std::string>(given));
    }
    using Given = std::conditional_t<std::is_same_v<Value, std::filesystem::path>, std::string, Value>;
    member = py::cast<Given>(given);
  }

  void set_one(Request& made, const std::string& name, py::handle value) const {
    for (const Keyword& keyword : all_) {
      if (keyword.name != name) continue;
      try {
        return keyword.set(made, value);
      } catch (const py::cast_error&) {
        throw py::type_error("the keyword '" + name + "' cannot be " +
                             py::cast<std::string>(py::repr(value)));
      }
    }
    throw py::type_error("there is no keyword '" + name + "'");
  }

  std::vector<Keyword> all_;
};

// Members of the format of a log, for requests that read one.

template <class Request>
std::string& log_format(Request& request) {
  return request.log_format.format;
}
template <class Request>
std::string& log_columns(Request& request) {
  return request.log_format.columns;
}
template <class Request>
std::vector<std::string>& log_topics(Request& request) {
  return request.log_format.topics;
}
template <class Request>
std::int64_t& log_robot(Request& request) {
  return request.log_format.robot;
}

}  // namespace waymark::python
