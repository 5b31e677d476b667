#include "core/io/vtu.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <new>

#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/base/version.h"

namespace lamella {

namespace {

static_assert(std::endian::native == std::endian::little, "the file says that it is so");

constexpr std::uint8_t kTriangle = 5, kTetrahedron = 10;
constexpr std::size_t kBlock = 1 << 18;  ///< bytes that are packed together
constexpr std::size_t kAtOnce = 8;       ///< blocks that wait to be written
constexpr int kLevel = 1;                ///< of zlib: three times as fast as 5, for a few percent
constexpr int kOffsetWidth = 20;

template <class T>
constexpr const char* kTypeName = nullptr;
template <>
constexpr const char* kTypeName<double> = "Float64";
template <>
constexpr const char* kTypeName<std::int32_t> = "Int32";
template <>
constexpr const char* kTypeName<std::int64_t> = "Int64";
template <>
constexpr const char* kTypeName<std::uint8_t> = "UInt8";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&' || c == '<' || c == '>' || c == '"' || c == '\t' || c == '\n' || c == '\r')
      out += "&#" + std::to_string(static_cast<int>(c)) + ";";
    else
      out += c;
  }
  return out;
}

/// Writes the XML at once and the arrays behind it; where each of them begins is filled in then.
class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}

  void text(const std::string& s) { out_ << s; }
  /// `value(i)` of i < tuples * components.
  template <class T, class Value>
  void array(const std::string& name, int components, std::size_t tuples, const Value& value) {
    std::string tag =
        std::string("<DataArray type=\"") + kTypeName<T> + "\" Name=\"" + escaped(name) + "\"";
    if (components > 1) tag += " NumberOfComponents=\"" + std::to_string(components) + "\"";
    promise(std::move(tag), [this, n = tuples * static_cast<std::size_t>(components),
                             value](const Progress& p) { return pack<T>(n, value, p); });
  }
  void strings(const std::string& name, std::vector<std::string> values) {
    std::string tag = "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" +
                      std::to_string(values.size()) + "\"";
    std::string bytes;
    for (const std::string& value : values) bytes += value.substr(0, value.find('\0')) + '\0';
    promise(std::move(tag), [this, bytes = std::move(bytes)](const Progress& p) {
      return pack<std::uint8_t>(
          bytes.size(), [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); }, p);
    });
  }
  /// The data behind the XML, and where they are into it.
  bool append(const Progress& progress) {
    out_ << "<AppendedData encoding=\"raw\">\n_";
    const std::streamoff begin = out_.tellp();
    std::vector<std::streamoff> offsets;
    for (std::size_t a = 0; a < promised_.size() && out_; ++a) {
      offsets.push_back(static_cast<std::streamoff>(out_.tellp()) - begin);
      const double count = static_cast<double>(promised_.size());
      promised_[a].data(
          progress.portion(static_cast<double>(a) / count, static_cast<double>(a + 1) / count));
      if (progress.cancelled()) return false;
    }
    out_ << "\n</AppendedData>\n</VTKFile>\n";
    for (std::size_t a = 0; a < offsets.size(); ++a)
      out_.seekp(promised_[a].place) << std::to_string(offsets[a]) + "\"";
    return out_.good();
  }

 private:
  struct Promise {
    std::streamoff place = 0;  ///< of its offset in the XML
    std::function<void(const Progress&)> data;
  };

  void promise(std::string tag, std::function<void(const Progress&)> data) {
    out_ << tag << " format=\"appended\" offset=\"";
    promised_.push_back({out_.tellp(), std::move(data)});
    out_ << std::string(kOffsetWidth, ' ') << "/>\n";
  }
  /// Blocks are packed side by side; the same bytes whatever the number of threads.
  template <class T, class Value>
  void pack(std::size_t count, const Value& value, const Progress& progress) {
    constexpr std::size_t of_block = kBlock / sizeof(T);
    const std::size_t blocks = (count + of_block - 1) / of_block;
    std::vector<std::uint32_t> head(3 + blocks);
    head[0] = static_cast<std::uint32_t>(blocks);
    head[1] = kBlock;
    head[2] = static_cast<std::uint32_t>(count % of_block * sizeof(T));
    const std::streamoff place = out_.tellp();
    const auto write_head = [&] {
      out_.write(reinterpret_cast<const char*>(head.data()),
                 static_cast<std::streamsize>(head.size() * sizeof head[0]));
    };
    write_head();
    for (std::size_t first = 0; first < blocks && out_; first += kAtOnce) {
      const std::size_t wave = std::min(kAtOnce, blocks - first);
      const bool all = parallel_each(
          wave, 0, progress.portion(0, 0),
          [&](std::size_t k) {
            const std::size_t begin = (first + k) * of_block,
                              end = std::min(count, begin + of_block);
            std::vector<T> values(end - begin);
            for (std::size_t i = begin; i < end; ++i) values[i - begin] = value(i);
            uLongf size = ::compressBound(values.size() * sizeof(T));
            packed_[k].resize(size);
            if (::compress2(packed_[k].data(), &size, reinterpret_cast<const Bytef*>(values.data()),
                            values.size() * sizeof(T), kLevel) != Z_OK)
              throw std::bad_alloc();
            packed_[k].resize(size);
          },
          1);
      if (!all) return;
      for (std::size_t k = 0; k < wave; ++k) {
        head[3 + first + k] = static_cast<std::uint32_t>(packed_[k].size());
        out_.write(reinterpret_cast<const char*>(packed_[k].data()),
                   static_cast<std::streamsize>(packed_[k].size()));
      }
      progress.report(static_cast<double>(first + wave) / static_cast<double>(blocks));
    }
    const std::streamoff end = out_.tellp();
    out_.seekp(place);
    write_head();
    out_.seekp(end);
  }

  std::ostream& out_;
  std::vector<Promise> promised_;
  std::array<std::vector<Bytef>, kAtOnce> packed_;
};

void write_names(const SimplexMesh<3>& mesh, const MeshFields& fields, Writer& w) {
  w.text("<FieldData>\n");
  w.strings("body_names", mesh.bodies);
  w.strings("group_names", mesh.groups);
  w.strings("unit", {unit_name(fields.unit)});
  w.strings("generator", {"Lamella " + version()});
  if (!fields.provenance.empty()) w.strings("provenance", {fields.provenance});
  w.text("</FieldData>\n");
}

void write_node_fields(const SimplexMesh<3>& mesh, const MeshFields& fields, Writer& w) {
  const std::size_t nodes = mesh.node_count();
  w.text(fields.metric ? "<PointData Tensors=\"metric\">\n" : "<PointData>\n");
  const auto scalar = [&](const char* name, const std::vector<double>* values) {
    if (values)
      w.array<double>(name, 1, nodes, [values](std::size_t i) { return (*values)[i + 1]; });
  };
  scalar("thickness", fields.thickness);
  scalar("layers", fields.layers);
  for (const NodeField& field : fields.of_nodes)
    w.array<double>(field.name, field.components, nodes, [&field](std::size_t i) {
      return field.values[i + static_cast<std::size_t>(field.components)];
    });
  if (fields.metric)
    w.array<double>("metric", 6, nodes, [metric = fields.metric](std::size_t i) {
      const auto [row, column] = kVtkTensor[i % 6];
      return (*metric)[i / 6 + 1](row, column);
    });
  w.text("</PointData>\n");
}

void write_cell_fields(const SimplexMesh<3>& mesh, const MeshFields& fields, Writer& w) {
  const std::size_t solids = mesh.elements.size(), cells = solids + mesh.facets.size();
  w.text("<CellData>\n");
  w.array<std::int32_t>("body", 1, cells, [&mesh, solids](std::size_t c) {
    return c < solids ? mesh.element_body[c] : -1;
  });
  const auto of_facets = [&](const char* name, const std::vector<std::int32_t>& values) {
    w.array<std::int32_t>(name, 1, cells, [&values, solids](std::size_t c) {
      return c < solids ? -1 : values[c - solids];
    });
  };
  of_facets("group", mesh.facet_group);
  of_facets("face", mesh.facet_face);
  const auto numbers = [&](const std::string& name, const std::vector<double>& values) {
    w.array<double>(name, 1, cells, [&values, solids](std::size_t c) {
      return c < solids ? values[c] : std::numeric_limits<double>::quiet_NaN();
    });
  };
  if (fields.quality) numbers("quality", *fields.quality);
  for (const ElementField& field : fields.of_elements) numbers(field.name, field.values);
  w.text("</CellData>\n");
}

void write_grid(const SimplexMesh<3>& mesh, Writer& w) {
  const std::size_t solids = mesh.elements.size(), cells = solids + mesh.facets.size();
  w.text("<Points>\n");
  w.array<double>("Points", 3, mesh.node_count(),
                  [&mesh](std::size_t i) { return mesh.points[i / 3 + 1][i % 3]; });
  w.text("</Points>\n<Cells>\n");
  w.array<std::int32_t>("connectivity", 1, 4 * solids + 3 * mesh.facets.size(),
                        [&mesh, solids](std::size_t i) {
                          if (i < 4 * solids) return mesh.elements[i / 4][i % 4] - 1;
                          i -= 4 * solids;
                          return mesh.facets[i / 3][i % 3] - 1;
                        });
  w.array<std::int64_t>("offsets", 1, cells, [solids](std::size_t c) {
    return static_cast<std::int64_t>(c < solids ? 4 * (c + 1) : solids + 3 * (c + 1));
  });
  w.array<std::uint8_t>("types", 1, cells,
                        [solids](std::size_t c) { return c < solids ? kTetrahedron : kTriangle; });
  w.text("</Cells>\n");
}

}  // namespace

Result<void> write_vtu(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const Progress& progress) {
  if (progress.cancelled()) return cancelled_error();
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  const std::size_t cells = mesh.elements.size() + mesh.facets.size();
  Writer w(target->stream());
  w.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
  write_names(mesh, fields, w);
  w.text("<Piece NumberOfPoints=\"" + std::to_string(mesh.node_count()) + "\" NumberOfCells=\"" +
         std::to_string(cells) + "\">\n");
  write_node_fields(mesh, fields, w);
  write_cell_fields(mesh, fields, w);
  write_grid(mesh, w);
  w.text("</Piece>\n</UnstructuredGrid>\n");
  const bool written = w.append(progress);
  if (progress.cancelled()) return cancelled_error();
  if (!written)
    return Error{Code::io, "\"" + file.string() + "\": writing failed.",
                 "Check the space on the disk."};
  return target->commit();
}

}  // namespace lamella
