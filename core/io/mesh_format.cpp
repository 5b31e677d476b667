#include "core/io/mesh_format.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "core/io/words.h"

namespace lamella {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Bytes of the UTF-8 character at `at`; stray bytes count as one.
std::size_t letter_at(const std::string& text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return end - at;
}

std::string allowed(const std::string& name, const NameRule& rule) {
  std::string out;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t length = letter_at(name, at);
    const auto c = static_cast<unsigned char>(name[at]);
    const bool plain = c < 128 && (std::isalnum(c) || rule.marks.find(name[at]) != rule.marks.npos);
    if (plain || (rule.any && c >= ' ' && c != '"' && c != 127 &&
                  rule.never.find(name[at]) == rule.never.npos))
      out += name.substr(at, length);
    else
      out += '_';
    at += length;
  }
  if (rule.any) return out.empty() ? "_" : out;
  // Some programs take what begins with a digit or a mark for a number.
  if (out.empty() || !(std::isalpha(static_cast<unsigned char>(out[0])) || out[0] == '_'))
    out.insert(0, "_");
  return out;
}

/// The beginning of a name, whole letters only.
std::string cut(const std::string& name, std::size_t longest) {
  std::size_t at = 0;
  while (at < name.size() && at + letter_at(name, at) <= longest) at += letter_at(name, at);
  return name.substr(0, at);
}

}  // namespace

std::optional<std::int64_t> reference_of(const std::string& name) {
  Words words(name);
  std::int64_t number = 0;
  if (words.next() == "ref" && words.read(number) && words.next().empty()) return number;
  return {};
}

std::vector<std::string> names_in_file(const std::vector<std::string>& names, const NameRule& rule,
                                       std::vector<std::string>& taken) {
  if (rule.exact) return names;
  std::vector<std::string> out;
  const std::size_t longest = rule.longest ? rule.longest : std::string::npos;
  const auto key = [&](const std::string& name) { return rule.shared ? lower(name) : name; };
  if (rule.references) {
    std::set<std::int64_t> numbers;
    for (const std::string& name : names)
      if (const auto number = reference_of(name)) numbers.insert(*number);
    if (numbers.size() == names.size()) return names;
    for (std::size_t i = 0; i < names.size(); ++i) out.push_back("ref " + std::to_string(i + 1));
    return out;
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string wanted = allowed(names[i], rule);
    std::string name = cut(wanted, longest);
    for (int k = 2; std::find(taken.begin(), taken.end(), key(name)) != taken.end(); ++k) {
      const std::string number = "_" + std::to_string(k);
      name = cut(wanted, longest == std::string::npos ? longest : longest - number.size()) + number;
    }
    taken.push_back(key(name));
    out.push_back(std::move(name));
  }
  return out;
}

void MeshFormats::add(std::vector<MeshFormat> formats) {
  for (MeshFormat& format : formats) formats_.push_back(std::move(format));
}

void MeshFormats::add_missing(const std::string& name, const std::string& ending,
                              const std::string& why) {
  missing_.push_back({name, ending, why});
}

Result<const MeshFormat*> MeshFormats::called(const std::string& name) const {
  std::string known;
  for (const MeshFormat& format : formats_) {
    if (format.name == lower(name)) return &format;
    known += (known.empty() ? "" : ", ") + format.name;
  }
  for (const Missing& missing : missing_)
    if (missing.name == lower(name)) return Error{Code::usage, missing.why, "Use " + known + "."};
  return Error{Code::usage, "There is no mesh format \"" + name + "\".", "Use " + known + "."};
}

Result<const MeshFormat*> MeshFormats::of_file(const std::filesystem::path& file) const {
  const std::string ending = lower(file.extension().string());
  std::string known;
  for (const MeshFormat& format : formats_)
    for (const std::string& own : format.endings) {
      if (own == ending) return &format;
      known += (known.empty() ? "" : ", ") + own + " (" + format.title + ")";
    }
  for (const Missing& missing : missing_)
    if (missing.ending == ending)
      return Error{Code::usage, "\"" + file.string() + "\": " + missing.why, "Use " + known + "."};
  return Error{Code::usage, "\"" + file.string() + "\": the ending names no mesh format.",
               "Use " + known + "."};
}

}  // namespace lamella
