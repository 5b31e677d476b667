#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

namespace lamella::test {

/// Why the value does not satisfy the schema (JSON Schema draft 7, the keywords that ours uses);
/// empty when it does. `root` holds the definitions.
inline std::string schema_fault(const nlohmann::json& value, const nlohmann::json& schema,
                                const nlohmann::json& root, const std::string& where = "") {
  using nlohmann::json;
  if (schema.contains("$ref"))
    return schema_fault(value,
                        root.at(json::json_pointer(schema["$ref"].get<std::string>().substr(1))),
                        root, where);
  const auto fault = [&](const std::string& what) { return where + ": " + what; };
  if (schema.contains("const") && value != schema["const"]) return fault("not the constant");
  if (schema.contains("enum") &&
      std::find(schema["enum"].begin(), schema["enum"].end(), value) == schema["enum"].end())
    return fault("none of the values");
  if (schema.contains("type")) {
    const std::string type = schema["type"];
    const bool good = type == "object"    ? value.is_object()
                      : type == "array"   ? value.is_array()
                      : type == "string"  ? value.is_string()
                      : type == "boolean" ? value.is_boolean()
                      : type == "integer" ? value.is_number_integer()
                                          : type == "number" && value.is_number();
    if (!good) return fault("no " + type);
  }
  if (value.is_number()) {
    const double x = value.get<double>();
    if (schema.contains("minimum") && x < schema["minimum"].get<double>())
      return fault("too small");
    if (schema.contains("maximum") && x > schema["maximum"].get<double>())
      return fault("too large");
    if (schema.contains("exclusiveMinimum") && x <= schema["exclusiveMinimum"].get<double>())
      return fault("too small");
  }
  if (value.is_string()) {
    const std::string text = value;
    if (text.size() < schema.value("minLength", 0u)) return fault("too short");
    if (schema.contains("pattern") &&
        !std::regex_search(text, std::regex(schema["pattern"].get<std::string>())))
      return fault("not of the pattern");
  }
  if (schema.contains("anyOf")) {
    std::string all;
    bool good = false;
    for (const json& one : schema["anyOf"]) {
      const std::string found = schema_fault(value, one, root, where);
      good = good || found.empty();
      all += found + "; ";
    }
    if (!good) return all;
  }
  if (value.is_array()) {
    if (value.size() < schema.value("minItems", 0u)) return fault("too few");
    if (schema.contains("maxItems") && value.size() > schema["maxItems"].get<std::size_t>())
      return fault("too many");
    if (schema.contains("items"))
      for (std::size_t k = 0; k < value.size(); ++k)
        if (const std::string found = schema_fault(value[k], schema["items"], root,
                                                   where + "[" + std::to_string(k) + "]");
            !found.empty())
          return found;
  }
  if (value.is_object()) {
    if (schema.contains("required"))
      for (const json& name : schema["required"])
        if (!value.contains(name.get<std::string>()))
          return fault(name.get<std::string>() + " is missing");
    for (const auto& [name, member] : value.items()) {
      if (!schema.contains("properties") || !schema["properties"].contains(name)) {
        if (!schema.value("additionalProperties", true)) return fault(name + " is not known");
        continue;
      }
      const std::string found =
          schema_fault(member, schema["properties"][name], root, where + "." + name);
      if (!found.empty()) return found;
    }
  }
  return "";
}

}  // namespace lamella::test
