#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/geometry/simplex.h"

namespace lamella {

using Json = nlohmann::ordered_json;

inline Json json_of(const Vec<3>& v) { return {v[0], v[1], v[2]}; }

/// Reads the members of one object; remembers the first complaint and which members were asked for.
class Members {
 public:
  Members(const Json& object, std::string path, std::string& complaint)
      : object_(object), path_(std::move(path)), complaint_(complaint) {
    if (!object.is_object()) complain("", "must be an object");
  }

  bool has(const std::string& name) {
    known_.push_back(name);
    return object_.is_object() && object_.contains(name);
  }
  const Json& at(const std::string& name) const { return object_.at(name); }

  void text(const std::string& name, std::string& value) {
    if (!has(name)) return;
    if (at(name).is_string())
      value = at(name).get<std::string>();
    else
      complain(name, "must be a text");
  }
  void flag(const std::string& name, bool& value) {
    if (!has(name)) return;
    if (at(name).is_boolean())
      value = at(name).get<bool>();
    else
      complain(name, "must be true or false");
  }
  template <class Integer>
  void integer(const std::string& name, Integer& value, std::int64_t least) {
    if (!has(name)) return;
    const Json& v = at(name);
    const bool big_enough =
        v.is_number_integer() &&
        (v.is_number_unsigned() ? v.get<std::uint64_t>() >= static_cast<std::uint64_t>(least)
                                : v.get<std::int64_t>() >= least);
    if (!big_enough || (sizeof(Integer) < 8 && v.get<std::int64_t>() > 1000000000))
      return complain(name, "must be a whole number of at least " + std::to_string(least));
    value = v.get<Integer>();
  }
  void integer(const std::string& name, std::optional<int>& value, std::int64_t least) {
    if (!has(name)) return;
    int number_read = static_cast<int>(least);
    integer(name, number_read, least);
    value = number_read;
  }
  void number(const std::string& name, double& value, bool zero_allowed) {
    if (!has(name)) return;
    const Json& v = at(name);
    if (!v.is_number() || !(v.get<double>() > 0 || (zero_allowed && v.get<double>() == 0)))
      return complain(
          name, zero_allowed ? "must be a number, not negative" : "must be a positive number");
    value = v.get<double>();
  }
  /// A positive one that has to be there.
  void needed(const std::string& name, double& value) {
    if (!has(name)) complain(name, "is needed");
    number(name, value, false);
  }
  void number(const std::string& name, std::optional<double>& value) {
    if (!has(name)) return;
    double number_read = 0;
    number(name, number_read, false);
    value = number_read;
  }
  /// Three numbers, in mm or as a direction.
  void vector(const std::string& name, Vec<3>& value, bool needed = false) {
    if (!has(name)) {
      if (needed) complain(name, "is needed");
      return;
    }
    const Json& v = at(name);
    if (!v.is_array() || v.size() != 3 ||
        !std::all_of(v.begin(), v.end(), [](const Json& x) { return x.is_number(); }))
      return complain(name, "must be a list of three numbers");
    for (int k = 0; k < 3; ++k) value[k] = v[k].get<double>();
  }
  /// Three sizes.
  void lengths(const std::string& name, Vec<3>& value) {
    const std::string before = complaint_;
    vector(name, value, true);
    if (complaint_ == before && !(value.minCoeff() > 0)) complain(name, "must be positive numbers");
  }
  /// One of `names`; its index is returned, 0 with a complaint.
  std::size_t choice(const std::string& name, const std::vector<std::string>& names) {
    std::string value;
    text(name, value);
    const auto it = std::find(names.begin(), names.end(), value);
    if (it != names.end()) return static_cast<std::size_t>(it - names.begin());
    std::string known;
    for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
    complain(name, "must be one of " + known);
    return 0;
  }
  /// A list of texts or of whole numbers.
  template <class Item>
  void list(const std::string& name, std::vector<Item>& value) {
    if (!has(name)) return;
    const auto good = [](const Json& i) {
      if constexpr (std::is_integral_v<Item>)
        return i.is_number_integer() && i.get<std::int64_t>() == static_cast<Item>(i);
      else
        return i.is_string();
    };
    if (!at(name).is_array() || !std::all_of(at(name).begin(), at(name).end(), good))
      return complain(name, std::is_integral_v<Item> ? "must be a list of whole numbers"
                                                     : "must be a list of texts");
    value = at(name).get<std::vector<Item>>();
  }
  /// A member that nobody asked for is a typing error, not something to pass over.
  void finish() {
    if (!object_.is_object()) return;
    for (const auto& [name, value] : object_.items())
      if (std::find(known_.begin(), known_.end(), name) == known_.end())
        complain(name, "is not known");
  }
  void complain(const std::string& name, const std::string& finding) {
    if (complaint_.empty())
      complaint_ =
          "\"" + path_ + (path_.empty() || name.empty() ? "" : ".") + name + "\" " + finding;
  }

 private:
  const Json& object_;
  std::string path_;
  std::string& complaint_;
  std::vector<std::string> known_;
};

}  // namespace lamella
