#include "core/io/stl.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "core/base/atomic_file.h"

namespace lamella {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little endian");

using Soup = std::vector<std::array<Vec<3>, 3>>;
constexpr std::size_t kHeader = 84;  // 80 bytes of text and the number of facets
constexpr std::size_t kRecord = 50;  // normal, three vertices, two bytes of attributes
constexpr std::size_t kPollEvery = 1 << 15;

Error bad(const std::filesystem::path& file, const std::string& finding, std::string hint) {
  return {Code::bad_input, file.filename().string() + ": " + finding, std::move(hint)};
}

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Words of a text, split at white space.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }
  /// The name of a solid may hold any words, so it is left by the line.
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
  }
  std::size_t position() const { return at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// `word` is lower case.
bool is(std::string_view token, std::string_view word) {
  if (token.size() != word.size()) return false;
  for (std::size_t k = 0; k < word.size(); ++k) {
    if (lower(token[k]) != word[k]) return false;
  }
  return true;
}

bool parse(std::string_view token, double& value) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  const auto [end, failure] = std::from_chars(token.data(), token.data() + token.size(), value);
  return failure == std::errc() && end == token.data() + token.size();
}

Result<Soup> read_ascii(const std::filesystem::path& file, std::string_view text,
                        const Progress& progress) {
  const std::string retry = "Export the part again, as a binary STL if the program allows it.";
  Words words(text);
  Soup soup;
  std::array<Vec<3>, 3> facet;
  int corners = 0;
  bool in_facet = false;
  bool in_solid = false;
  const auto where = [&] { return std::string(" in facet ") + std::to_string(soup.size() + 1); };
  for (std::string_view token = words.next(); !token.empty(); token = words.next()) {
    if (is(token, "vertex")) {
      if (!in_facet || corners == 3) {
        return bad(file, "a vertex too many" + where() + " of this STL", retry);
      }
      for (int k = 0; k < 3; ++k) {
        token = words.next();
        if (token.empty()) return bad(file, "truncated STL: it ends" + where(), retry);
        if (!parse(token, facet[corners][k])) {
          std::string finding(token.substr(0, 24));
          return bad(file, finding + " is no coordinate" + where() + " of this STL", retry);
        }
      }
      ++corners;
    } else if (is(token, "facet")) {
      if (in_facet) return bad(file, "endfacet is missing" + where() + " of this STL", retry);
      in_facet = true;
      corners = 0;
      if (soup.size() % kPollEvery == 0) {
        if (progress.cancelled()) return cancelled_error();
        progress.report(static_cast<double>(words.position()) / static_cast<double>(text.size()));
      }
    } else if (is(token, "endfacet")) {
      if (!in_facet || corners != 3) {
        return bad(file, "fewer than three vertices" + where() + " of this STL", retry);
      }
      soup.push_back(facet);
      in_facet = false;
    } else if (is(token, "solid") || is(token, "endsolid")) {
      in_solid = is(token, "solid");
      words.skip_line();
    }
  }
  if (in_facet || in_solid) {
    return bad(file,
               "truncated STL: the text ends after " + std::to_string(soup.size()) +
                   " facets without endsolid",
               "Copy or export the file again.");
  }
  if (soup.empty()) return bad(file, "this STL holds no facet", "Export the part again.");
  return soup;
}

Result<Soup> read_binary(const std::filesystem::path& file, std::string_view bytes,
                         std::size_t count, const Progress& progress) {
  if (count == 0) return bad(file, "this STL holds no facet", "Export the part again.");
  Soup soup(count);
  for (std::size_t f = 0; f < count; ++f) {
    std::array<float, 12> numbers;  // the normal first: not used
    std::memcpy(numbers.data(), bytes.data() + kHeader + f * kRecord, sizeof(numbers));
    for (int v = 0; v < 3; ++v) {
      for (int k = 0; k < 3; ++k) soup[f][v][k] = numbers[3 + 3 * v + k];
    }
    if (f % kPollEvery == 0) {
      if (progress.cancelled()) return cancelled_error();
      progress.report(static_cast<double>(f) / static_cast<double>(count));
    }
  }
  return soup;
}

bool looks_like_text(std::string_view bytes) {
  for (const char c : bytes.substr(0, 512)) {
    if (static_cast<unsigned char>(c) < 0x20 && !is_space(c)) return false;
  }
  return true;
}

}  // namespace

Result<std::vector<std::array<Vec<3>, 3>>> read_stl(const std::filesystem::path& file,
                                                    const Progress& progress) {
  Result<std::string> content = read_file(file);
  if (!content) return content.error();
  const std::string_view bytes = *content;
  if (bytes.empty()) return bad(file, "the file is empty", "Copy or export it again.");

  // The byte count decides: many binary files begin with "solid" too.
  std::uint32_t promised = 0;
  if (bytes.size() >= kHeader) std::memcpy(&promised, bytes.data() + 80, sizeof(promised));
  const std::size_t expected = kHeader + kRecord * promised;
  if (bytes.size() == expected) return read_binary(file, bytes, promised, progress);

  if (looks_like_text(bytes)) {
    if (is(Words(bytes).next(), "solid")) return read_ascii(file, bytes, progress);
    return bad(file, "this is a text but not an STL (it does not begin with 'solid')",
               "Lamella reads STL and STEP; check the name of the file.");
  }
  if (bytes.size() < kHeader) {
    return bad(file, "not an STL: " + std::to_string(bytes.size()) + " bytes are too few",
               "Copy or export it again.");
  }
  if (bytes.size() < expected) {
    // A count far beyond what the file could hold comes from a file of another kind.
    if (promised > 1000 * (bytes.size() / kRecord + 1)) {
      return bad(file, "not an STL: its facet count does not fit its size",
                 "Lamella reads STL and STEP; check the file.");
    }
    return bad(file,
               "truncated STL: " + std::to_string(promised) + " facets are promised, " +
                   std::to_string((bytes.size() - kHeader) / kRecord) + " are there",
               "Copy or export it again.");
  }
  return bad(file,
             "not an STL: " + std::to_string(bytes.size() - expected) +
                 " bytes follow the last of its " + std::to_string(promised) + " facets",
             "Copy or export it again.");
}

Result<void> write_stl(const ReferenceSurface<3>& surface, const std::filesystem::path& file) {
  std::string bytes(kHeader + kRecord * surface.facets.size(), '\0');
  constexpr std::string_view kTitle = "Lamella binary STL, unit mm";
  std::memcpy(bytes.data(), kTitle.data(), kTitle.size());
  const auto count = static_cast<std::uint32_t>(surface.facets.size());
  std::memcpy(bytes.data() + 80, &count, sizeof(count));
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    std::array<Vec<3>, 3> p;
    for (int v = 0; v < 3; ++v) p[v] = surface.points[surface.facets[f][v]];
    const Vec<3> normal = facet_normal<3>(p).stableNormalized();
    std::array<float, 12> numbers;
    for (int k = 0; k < 3; ++k) {
      numbers[k] = static_cast<float>(normal[k]);
      for (int v = 0; v < 3; ++v) numbers[3 + 3 * v + k] = static_cast<float>(p[v][k]);
    }
    std::memcpy(bytes.data() + kHeader + f * kRecord, numbers.data(), sizeof(numbers));
  }
  return write_file(file, bytes);
}

}  // namespace lamella
