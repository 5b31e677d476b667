#include "core/study/study_file.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/version.h"

namespace lamella {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchema = 1;

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
  void number(const std::string& name, double& value, bool zero_allowed) {
    if (!has(name)) return;
    const Json& v = at(name);
    if (!v.is_number() || !(v.get<double>() > 0 || (zero_allowed && v.get<double>() == 0)))
      return complain(
          name, zero_allowed ? "must be a number, not negative" : "must be a positive number");
    value = v.get<double>();
  }
  void number(const std::string& name, std::optional<double>& value) {
    if (!has(name)) return;
    double number_read = 0;
    number(name, number_read, false);
    value = number_read;
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

BodySettings read_body(const Json& json, std::size_t index, std::string& complaint) {
  BodySettings body;
  Members m(json, "bodies[" + std::to_string(index) + "]", complaint);
  m.text("name", body.name);
  if (body.name.empty()) m.complain("name", "is needed");
  m.integer("layers", body.layers, 1);
  m.number("alpha", body.alpha, true);
  m.number("h_min", body.h_min);
  m.number("h_max", body.h_max);
  m.flag("visible", body.visible);
  m.finish();
  return body;
}

StudyOptions read_options(const Json& json, std::string& complaint) {
  StudyOptions options;
  Members m(json, "options", complaint);
  m.number("chord_tolerance", options.chord_tolerance);
  m.number("angle_tolerance", options.angle_tolerance, false);
  m.integer("iterations", options.iterations, 1);
  m.integer("threads", options.threads, 0);
  m.integer("seed", options.seed, 0);
  std::string detector(detector_name(options.detector));
  m.text("detector", detector);
  if (const auto known = detector_from_name(detector))
    options.detector = *known;
  else
    m.complain("detector", "must be \"geometric\" or \"neighborhood\"");
  m.finish();
  return options;
}

}  // namespace

std::string study_to_json(const Study& study) {
  Json json;
  json["schema"] = kSchema;
  json["program"] = "Lamella " + version();
  json["name"] = study.name;
  json["unit"] = "mm";
  json["inputs"] = study.inputs;
  json["bodies"] = Json::array();
  for (const BodySettings& body : study.bodies) {
    Json b;
    b["name"] = body.name;
    b["layers"] = body.layers;
    b["alpha"] = body.alpha;
    if (body.h_min) b["h_min"] = *body.h_min;
    if (body.h_max) b["h_max"] = *body.h_max;
    b["visible"] = body.visible;
    json["bodies"].push_back(std::move(b));
  }
  const StudyOptions& o = study.options;
  Json& options = json["options"];
  if (o.chord_tolerance) options["chord_tolerance"] = *o.chord_tolerance;
  options["angle_tolerance"] = o.angle_tolerance;
  options["iterations"] = o.iterations;
  options["threads"] = o.threads;
  options["seed"] = o.seed;
  options["detector"] = detector_name(o.detector);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<Study> study_from_json(const std::string& text, const std::string& where) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + where + "\": " + finding + ".", hint};
  };
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded())
    return refuse("not a study, it is no valid JSON", "Give a study, a STEP or an STL file.");
  if (!json.is_object() || !json.contains("schema") || !json["schema"].is_number_integer())
    return refuse("not a study, the member \"schema\" is missing", "Give a study of Lamella.");
  if (json["schema"].get<int>() > kSchema)
    return refuse("written by a newer version (schema " + json["schema"].dump() + ")",
                  "Update Lamella.");
  std::string complaint;
  Study study;
  Members m(json, "", complaint);
  m.has("schema");
  m.has("program");
  std::string unit = "mm";
  m.text("unit", unit);
  if (unit != "mm") m.complain("unit", "must be \"mm\"");
  m.text("name", study.name);
  if (m.has("inputs")) {
    const Json& inputs = m.at("inputs");
    const bool texts =
        inputs.is_array() &&
        std::all_of(inputs.begin(), inputs.end(), [](const Json& i) { return i.is_string(); });
    if (texts)
      study.inputs = inputs.get<std::vector<std::string>>();
    else
      m.complain("inputs", "must be a list of file names");
  }
  if (m.has("bodies")) {
    if (!m.at("bodies").is_array())
      m.complain("bodies", "must be a list");
    else
      for (const Json& body : m.at("bodies"))
        study.bodies.push_back(read_body(body, study.bodies.size(), complaint));
  }
  if (m.has("options")) study.options = read_options(m.at("options"), complaint);
  m.finish();
  if (!complaint.empty()) return refuse(complaint, "Correct or remove it.");
  return study;
}

Result<Study> read_study(const std::filesystem::path& file) {
  Result<std::string> text = read_file(file);
  if (!text) return text.error();
  return study_from_json(*text, file.string());
}

Result<void> write_study(const Study& study, const std::filesystem::path& file) {
  return write_file(file, study_to_json(study));
}

std::vector<std::filesystem::path> input_files(const Study& study,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const std::string& input : study.inputs) {
    const std::filesystem::path path(input);
    files.push_back(path.is_absolute() || folder.empty() ? path : folder / path);
  }
  return files;
}

}  // namespace lamella
