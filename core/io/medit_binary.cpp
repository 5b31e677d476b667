#include "core/io/medit_binary.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/io/words.h"

namespace lamella {

namespace {

constexpr std::int32_t kDimension = 3, kVertices = 4, kSolAtVertices = 62, kEnd = 54;
constexpr std::int32_t kSwapped = 1 << 24;  // the first number, 1, of the other byte order

/// Sections of simplices: keyword, name, nodes of an entry.
struct Kind {
  std::int32_t keyword;
  const char* name;
  int nodes;
};
constexpr std::array<Kind, 3> kSimplices = {
    {{5, "Edges", 2}, {6, "Triangles", 3}, {8, "Tetrahedra", 4}}};

/// Numbers one after the other; past the end they are 0 and `good` is false.
class Numbers {
 public:
  explicit Numbers(std::string_view bytes) : bytes_(bytes) {}

  int version = 1;

  std::int32_t word() { return take<std::int32_t>(); }
  std::int64_t integer() { return version < 4 ? take<std::int32_t>() : take<std::int64_t>(); }
  std::int64_t position() { return version < 3 ? take<std::int32_t>() : take<std::int64_t>(); }
  double real() { return version < 2 ? static_cast<double>(take<float>()) : take<double>(); }
  bool good() const { return good_; }
  void fail() { good_ = false; }
  std::size_t left() const { return bytes_.size() - at_; }
  /// The next section, which lies behind this place.
  void go(std::int64_t position) {
    const auto to = static_cast<std::size_t>(position);
    good_ = good_ && position > 0 && to > at_ && to <= bytes_.size();
    if (good_) at_ = to;
  }

 private:
  template <class T>
  T take() {
    T value{};
    good_ = good_ && left() >= sizeof value;
    if (!good_) return value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// So many entries, each a line of reals and then integers. An entry takes a byte a number at
/// least, so that a count that cannot be is found before its text is made.
void copy_entries(Numbers& in, std::int64_t count, int reals, int integers, TextBuilder& out) {
  const auto least = static_cast<std::int64_t>(reals + integers);
  if (count < 0 || count > static_cast<std::int64_t>(in.left()) / std::max<std::int64_t>(1, least))
    return in.fail();
  out << count << '\n';
  for (std::int64_t i = 0; i < count && in.good(); ++i) {
    for (int k = 0; k < reals; ++k) out << in.real() << ' ';
    for (int k = 0; k < integers; ++k) out << in.integer() << ' ';
    out << '\n';
  }
}

/// Values at the nodes; anything but one field is left to the reader to refuse.
void copy_solution(Numbers& in, int dimension, TextBuilder& out) {
  const std::int64_t count = in.integer();
  const std::int32_t fields = in.word();
  int values = 0;
  std::string types;
  for (std::int32_t k = 0; k < fields && in.good(); ++k) {
    const std::int32_t type = in.word();
    types += ' ' + std::to_string(type);
    values += type == 1 ? 1 : type == 2 ? dimension : dimension * (dimension + 1) / 2;
  }
  if (count < 0 || values < 1 || count > static_cast<std::int64_t>(in.left()) / values)
    return in.fail();
  out << count << '\n' << fields << types << '\n';
  for (std::int64_t i = 0; i < count && in.good(); ++i) {
    for (int k = 0; k < values; ++k) out << in.real() << ' ';
    out << '\n';
  }
}

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

Result<std::string> text_of_medit_binary(const std::filesystem::path& file,
                                         std::string_view bytes) {
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, file.string() + finding, hint};
  };
  Numbers in(bytes);
  const std::int32_t order = in.word();
  in.version = in.word();
  if (order == kSwapped)
    return refuse(" was written by a machine of the other byte order.", "Save it as text there.");
  if (order != 1 || in.version < 1 || in.version > 4)
    return refuse(" is not a Medit file: it does not begin as a binary one.",
                  "Check the type of the file.");
  TextBuilder out;
  out << "MeshVersionFormatted " << in.version << '\n';
  int dimension = 0;
  while (in.good()) {
    const std::int32_t keyword = in.word();
    if (keyword == kEnd) break;
    const std::int64_t next = in.position();
    const auto* const kind = std::find_if(kSimplices.begin(), kSimplices.end(),
                                          [&](const Kind& k) { return k.keyword == keyword; });
    if (keyword == kDimension) {
      dimension = in.word();
      if (dimension < 2 || dimension > 3) in.fail();
      out << "Dimension " << dimension << '\n';
    } else if (keyword == kVertices) {
      out << "Vertices\n";
      copy_entries(in, in.integer(), dimension, 1, out);
    } else if (kind != kSimplices.end()) {
      out << kind->name << '\n';
      copy_entries(in, in.integer(), 0, kind->nodes + 1, out);
    } else if (keyword == kSolAtVertices) {
      out << "SolAtVertices\n";
      copy_solution(in, dimension, out);
    }
    // The last section may say that there is none behind it.
    if (in.good() && next == 0) break;
    if (in.good() && static_cast<std::size_t>(next) != bytes.size() - in.left()) in.go(next);
  }
  if (!in.good() || dimension == 0)
    return refuse(" is truncated or damaged.", "Check that it was written or copied completely.");
  out << "End\n";
  return out.text();
}

template <int D>
std::string medit_binary(const SimplexMesh<D>& mesh, const std::vector<std::int32_t>& body_refs,
                         const std::vector<std::int32_t>& group_refs) {
  constexpr std::size_t word = sizeof(std::int32_t);
  const std::size_t size = 100 + mesh.node_count() * (D * sizeof(double) + word) +
                           mesh.elements.size() * (D + 2) * word +
                           mesh.facets.size() * (D + 1) * word;
  const bool large = size > std::numeric_limits<std::int32_t>::max();
  const std::size_t position = large ? sizeof(std::int64_t) : word;
  std::string out;
  out.reserve(size);
  /// A keyword, and where the next one is: behind so many bytes.
  const auto begin = [&](std::int32_t keyword, std::size_t bytes) {
    put(out, keyword);
    const std::size_t next = out.size() + position + bytes;
    large ? put(out, static_cast<std::int64_t>(next)) : put(out, static_cast<std::int32_t>(next));
  };
  put(out, std::int32_t{1});
  put(out, std::int32_t{large ? 3 : 2});
  begin(kDimension, word);
  put(out, std::int32_t{D});
  begin(kVertices, word + mesh.node_count() * (D * sizeof(double) + word));
  put(out, static_cast<std::int32_t>(mesh.node_count()));
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    for (int k = 0; k < D; ++k) put(out, mesh.points[v][k]);
    put(out, std::int32_t{0});
  }
  const auto simplices = [&](std::int32_t keyword, const auto& all,
                             const std::vector<std::int32_t>& index,
                             const std::vector<std::int32_t>& refs) {
    const std::size_t nodes = all.empty() ? 0 : all[0].size();
    begin(keyword, word + all.size() * (nodes + 1) * word);
    put(out, static_cast<std::int32_t>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const NodeId v : all[i]) put(out, v);
      put(out, refs[index[i]]);
    }
  };
  simplices(kSimplices[D - 1].keyword, mesh.elements, mesh.element_body, body_refs);
  simplices(kSimplices[D - 2].keyword, mesh.facets, mesh.facet_group, group_refs);
  put(out, kEnd);
  large ? put(out, std::int64_t{0}) : put(out, std::int32_t{0});
  return out;
}

template std::string medit_binary<2>(const SimplexMesh<2>&, const std::vector<std::int32_t>&,
                                     const std::vector<std::int32_t>&);
template std::string medit_binary<3>(const SimplexMesh<3>&, const std::vector<std::int32_t>&,
                                     const std::vector<std::int32_t>&);

}  // namespace lamella
