#include "app/cli_set.h"

#include <algorithm>

#include "app/cli_common.h"
#include "app/cli_text.h"
#include "core/study/request.h"
#include "core/study/study_file.h"

namespace lamella::cli {

namespace {

constexpr std::size_t kMostCombinations = 10000;

Error misread(const std::string& path, const std::string& finding, const std::string& hint) {
  return {Code::usage, "--set " + path + ": " + finding + ".", hint};
}

/// Of an entry of a list; empty where it has none.
std::string name_of(const Json& item) {
  const auto name = item.is_object() ? item.find("name") : item.end();
  return name != item.end() && name->is_string() ? name->get<std::string>() : "";
}

std::string names_in(const Json& list) {
  std::string names;
  for (const Json& item : list)
    if (const std::string name = name_of(item); !name.empty())
      names += (names.empty() ? "\"" : ", \"") + name + "\"";
  return names.empty() ? "It is empty." : "It has " + names + ".";
}

/// The entry of the list that the rest of a path begins with; the rest then begins behind it. Names
/// may have points: the longest that fits is meant; where none fits, the number of the entry.
Json* entry_of(Json& list, std::string& rest) {
  Json* found = nullptr;
  std::size_t length = 0;
  const auto look = [&](Json& entry, const std::string& name) {
    if (name.empty() || name.size() < length || rest.compare(0, name.size(), name) != 0) return;
    if (rest.size() != name.size() && rest[name.size()] != '.') return;
    found = &entry;
    length = name.size();
  };
  for (Json& entry : list) look(entry, name_of(entry));
  for (std::size_t k = 0; !found && k < list.size(); ++k) look(list[k], std::to_string(k));
  if (found) rest.erase(0, std::min(rest.size(), length + 1));
  return found;
}

Result<void> put(Json& json, const std::string& path, const std::string& value) {
  Json* at = &json;
  std::string rest = path;
  for (;;) {
    if (at->is_array()) {
      Json* entry = entry_of(*at, rest);
      if (!entry) return misread(path, "there is no \"" + rest + "\" in the list", names_in(*at));
      at = entry;
      if (rest.empty()) break;
      continue;
    }
    if (!at->is_object())
      return misread(path, "there is nothing called \"" + rest + "\"", "See the study's JSON.");
    const std::size_t point = rest.find('.');
    const std::string key = rest.substr(0, point);
    at = &(*at)[key];
    if (point == rest.npos) break;
    rest.erase(0, point + 1);
    if (at->is_null()) *at = Json::object();
  }
  Json parsed = Json::parse(value, nullptr, false);
  *at = parsed.is_discarded() ? Json(value) : std::move(parsed);
  return {};
}

}  // namespace

Result<Setting> read_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  Setting setting{text.substr(0, equals), {}};
  if (equals == text.npos || equals == 0)
    return Error{Code::usage, "--set " + text + " is not understood.",
                 "Write it as PATH=VALUE, or PATH=VALUE,VALUE for a sweep."};
  const std::string root = setting.path.substr(0, setting.path.find('.'));
  if (root == "inputs" || root == "embed_inputs" || root == "schema" || root == "unit")
    return misread(setting.path, "this is no setting", "Change the study instead.");
  std::string value;
  int depth = 0;
  bool quoted = false;
  for (const char c : text.substr(equals + 1)) {
    if (c == '"') quoted = !quoted;
    if (!quoted) depth += (c == '[' || c == '{') - (c == ']' || c == '}');
    if (c == ',' && depth == 0 && !quoted) {
      setting.values.push_back(std::exchange(value, {}));
      continue;
    }
    value += c;
  }
  setting.values.push_back(value);
  for (const std::string& one : setting.values)
    if (one.empty()) return misread(setting.path, "a value is empty", "Give one after each comma.");
  return setting;
}

Result<std::vector<Combination>> combinations_of(const std::vector<Setting>& settings) {
  std::vector<Combination> all(1);
  for (const Setting& setting : settings) {
    if (all.size() * setting.values.size() > kMostCombinations)
      return Error{Code::usage,
                   "The sweep has more than " + std::to_string(kMostCombinations) + " meshes.",
                   "Give fewer values."};
    std::vector<Combination> grown;
    for (const Combination& begun : all)
      for (const std::string& value : setting.values) {
        grown.push_back(begun);
        grown.back().push_back(value);
      }
    all = std::move(grown);
  }
  return all;
}

Result<Study> with_settings(const Study& study, const std::vector<Setting>& settings,
                            const Combination& values) {
  Json json = Json::parse(study_to_json(study));
  for (std::size_t s = 0; s < settings.size(); ++s) {
    const std::string& path = settings[s].path;
    if (path.rfind("body.", 0) != 0) {
      if (Result<void> done = put(json, path, values[s]); !done) return done.error();
      continue;
    }
    const std::string member = path == "body.n" ? "layers" : path.substr(5);
    if (!json["bodies"].is_array()) continue;  // which the study's reader refuses
    for (Json& body : json["bodies"]) {
      // What is around the bodies is none of them.
      if (study.domain && name_of(body) == kBackground) continue;
      if (Result<void> done = put(body, member, values[s]); !done) return done.error();
    }
  }
  Result<Study> made = study_from_json(json.dump(), "--set");
  if (made) return made;
  Error error = made.error();
  error.code = Code::usage;
  return error;
}

}  // namespace lamella::cli
