#include "core/cad/tessellated_step.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <unordered_map>

namespace lamella {
namespace {

/// An argument of an entity: a number, a reference (#12), a text, or a list of arguments.
struct Value {
  double number = 0;
  std::int64_t reference = 0;
  std::string_view text;
  std::vector<Value> list;

  const Value& at(std::size_t k) const {
    static const Value none;
    return k < list.size() ? list[k] : none;
  }
  /// The number as an index from 1, 0 when it is none.
  std::size_t index() const {
    return number >= 1 && number < 4e9 ? static_cast<std::size_t>(number) : 0;
  }
};

class Arguments {
 public:
  Arguments(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  /// Reads one value; false at the end of the text or where lists nest deeper than any entity's.
  bool read(Value& value, int depth = 0) {
    skip_blanks();
    if (at_ >= text_.size() || depth > 8) return false;
    if (text_[at_] == '(') {
      ++at_;
      for (;;) {
        skip_blanks();
        if (at_ >= text_.size()) return false;
        if (text_[at_] == ')') break;
        if (text_[at_] == ',') {
          ++at_;
          continue;
        }
        if (!read(value.list.emplace_back(), depth + 1)) return false;
      }
      ++at_;
      return true;
    }
    const std::size_t begin = at_;
    if (text_[at_] == '\'') {
      do {  // two quotes within a text stand for one
        at_ = text_.find('\'', at_ + 1);
        if (at_ == std::string_view::npos) return false;
        value.text = text_.substr(begin + 1, at_ - begin - 1);
        ++at_;
      } while (at_ < text_.size() && text_[at_] == '\'');
      return true;
    }
    at_ = std::min(text_.find_first_of(",()';", at_), text_.size());
    if (at_ == begin) return false;
    const char* end = text_.data() + at_;
    if (text_[begin] == '#')
      std::from_chars(text_.data() + begin + 1, end, value.reference);
    else  // from_chars knows no plus
      std::from_chars(text_.data() + begin + (text_[begin] == '+' ? 1 : 0), end, value.number);
    return true;
  }

 private:
  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  std::string_view text_;
  std::size_t at_;
};

class Reader {
 public:
  explicit Reader(std::string_view text) {
    coordinates_ = by_number(collect(text, "COORDINATES_LIST"));
    complex_faces_ = by_number(collect(text, "COMPLEX_TRIANGULATED_FACE"));
    faces_ = by_number(collect(text, "TRIANGULATED_FACE"));
    solids_ = collect(text, "TESSELLATED_SOLID");
    if (solids_.empty()) solids_ = collect(text, "TESSELLATED_SHELL");
    unit_ = unit_of(text);
  }

  std::vector<TessellatedBody> bodies() const {
    std::vector<TessellatedBody> bodies;
    for (const auto& [id, solid] : solids_) {
      TessellatedBody body{std::string(solid.at(0).text), {}};
      for (const Value& item : solid.at(1).list) add_face(item.reference, body.soup);
      if (!body.soup.empty()) bodies.push_back(std::move(body));
    }
    return bodies;
  }

 private:
  using Entities = std::vector<std::pair<std::int64_t, Value>>;  // in the order of the text
  using Numbered = std::unordered_map<std::int64_t, Value>;

  static Numbered by_number(Entities entities) {
    return {std::make_move_iterator(entities.begin()), std::make_move_iterator(entities.end())};
  }

  /// The entities "#id=TYPE(..)".
  static Entities collect(std::string_view text, std::string_view type) {
    Entities found;
    for (std::size_t at = text.find(type); at != std::string_view::npos;
         at = text.find(type, at + type.size())) {
      const std::size_t open = text.find_first_not_of(" \t\r\n", at + type.size());
      if (at == 0 || open == std::string_view::npos || text[open] != '(') continue;
      const std::size_t before = text.find_last_not_of(" \t\r\n", at - 1);
      if (before == std::string_view::npos || text[before] != '=') continue;
      const std::size_t number = text.rfind('#', before);
      if (number == std::string_view::npos) continue;
      Value value;
      std::int64_t id = 0;
      std::from_chars(text.data() + number + 1, text.data() + before, id);
      if (Arguments(text, open).read(value)) found.emplace_back(id, std::move(value));
    }
    return found;
  }

  static double unit_of(std::string_view text) {
    const auto holds = [&](std::string_view words) {
      return text.find(words) != std::string_view::npos;
    };
    if (holds("CONVERSION_BASED_UNIT('INCH'") || holds("CONVERSION_BASED_UNIT('inch'")) return 25.4;
    if (holds("CONVERSION_BASED_UNIT('FOOT'") || holds("CONVERSION_BASED_UNIT('foot'"))
      return 304.8;
    if (holds("SI_UNIT(.MILLI.,.METRE.)")) return 1;
    if (holds("SI_UNIT(.CENTI.,.METRE.)")) return 10;
    if (holds("SI_UNIT(.MICRO.,.METRE.)")) return 1e-3;
    return holds("SI_UNIT($,.METRE.)") ? 1000 : 1;
  }

  static const Value* find(const Numbered& entities, std::int64_t id) {
    const auto it = entities.find(id);
    return it == entities.end() ? nullptr : &it->second;
  }

  void add_face(std::int64_t id, TriangleSoup& soup) const {
    const bool strips = find(complex_faces_, id) != nullptr;
    const Value* face = strips ? find(complex_faces_, id) : find(faces_, id);
    if (face == nullptr) return;
    const Value* list = find(coordinates_, face->at(1).reference);
    if (list == nullptr) return;
    const std::vector<Value>& points = list->at(2).list;
    const std::vector<Value>& numbers = face->at(5).list;
    const auto point = [&](const Value& local, Vec<3>& x) {
      std::size_t k = local.index();
      if (!numbers.empty()) k = k >= 1 && k <= numbers.size() ? numbers[k - 1].index() : 0;
      if (k < 1 || k > points.size() || points[k - 1].list.size() != 3) return false;
      for (int d = 0; d < 3; ++d) x[d] = unit_ * points[k - 1].list[d].number;
      return true;
    };
    const auto triangle = [&](const Value& a, const Value& b, const Value& c) {
      std::array<Vec<3>, 3> corners;
      if (point(a, corners[0]) && point(b, corners[1]) && point(c, corners[2]) &&
          corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
        soup.push_back(corners);
    };
    if (!strips) {
      for (const Value& t : face->at(6).list) triangle(t.at(0), t.at(1), t.at(2));
      return;
    }
    for (const Value& strip : face->at(6).list)
      for (std::size_t k = 2; k < strip.list.size(); ++k)
        triangle(strip.at(k - 2), strip.at(k - 1 + k % 2), strip.at(k - k % 2));
    for (const Value& fan : face->at(7).list)
      for (std::size_t k = 2; k < fan.list.size(); ++k)
        triangle(fan.at(0), fan.at(k - 1), fan.at(k));
  }

  Numbered coordinates_, complex_faces_, faces_;
  Entities solids_;
  double unit_ = 1;
};

}  // namespace

std::vector<TessellatedBody> tessellated_bodies(std::string_view text) {
  if (text.find("TESSELLATED_") == std::string_view::npos) return {};
  return Reader(text).bodies();
}

}  // namespace lamella
