#include "core/io/msh.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>

#include "core/base/atomic_file.h"

namespace lamella {

namespace {

constexpr int kTriangle = 2, kTetrahedron = 4;

/// Appends numbers as the 4.1 format wants them, in text or binary, and hands full blocks on.
class Writer {
 public:
  Writer(std::ostream& out, bool binary) : out_(out), binary_(binary) {}
  ~Writer() { flush(); }

  void text(std::string_view s) { buffer_.append(s); }
  void integer(std::int32_t v) { number(v); }
  void size(std::uint64_t v) { number(v); }
  void real(double v) { number(v); }
  /// Ends a record: a line in text, nothing in binary.
  void end() {
    if (!binary_ && !buffer_.empty()) buffer_.back() = '\n';
    if (buffer_.size() > (1u << 20)) flush();
  }
  /// Ends a section's data, so that the next keyword begins a line.
  void close() {
    if (binary_) buffer_.push_back('\n');
  }

 private:
  template <class T>
  void number(T v) {
    if (binary_) {
      char raw[sizeof(T)];
      std::memcpy(raw, &v, sizeof(T));
      buffer_.append(raw, sizeof(T));
    } else {
      char digits[32];
      const auto end = std::to_chars(digits, digits + sizeof digits, v).ptr;
      buffer_.append(digits, end).push_back(' ');
    }
  }
  void flush() {
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }
  std::ostream& out_;
  bool binary_;
  std::string buffer_;
};

/// A physical name stands between double quotes on one line.
std::string quotable(std::string name) {
  for (char& c : name)
    if (c == '"' || static_cast<unsigned char>(c) < ' ') c = '_';
  return name;
}

struct SurfaceEntity {
  std::int32_t group, face;
  std::vector<std::int32_t> facets;
};

/// One entity per (group, CAD face), in that order.
std::vector<SurfaceEntity> surface_entities(const SimplexMesh<3>& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::int32_t>> by_face;
  for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    by_face[{mesh.facet_group[f], mesh.facet_face[f]}].push_back(static_cast<std::int32_t>(f));
  std::vector<SurfaceEntity> entities;
  for (auto& [key, facets] : by_face)
    entities.push_back({key.first, key.second, std::move(facets)});
  return entities;
}

struct Box {
  Vec<3> low = Vec<3>::Constant(1e300), high = Vec<3>::Constant(-1e300);
  void add(const Vec<3>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  void write(Writer& w) const {
    for (int i = 0; i < 3; ++i) w.real(low[i]);
    for (int i = 0; i < 3; ++i) w.real(high[i]);
  }
};

/// Nodes by the entity that owns them: the first surface they lie on, else the body.
struct Owners {
  std::vector<std::vector<NodeId>> surface, volume;
};

Owners owners_of(const SimplexMesh<3>& mesh, const std::vector<SurfaceEntity>& surfaces) {
  Owners owners;
  owners.surface.resize(surfaces.size());
  owners.volume.resize(mesh.bodies.size());
  std::vector<std::int32_t> owner(mesh.points.size(), -1);
  const auto count = static_cast<std::int32_t>(surfaces.size());
  for (std::int32_t s = 0; s < count; ++s)
    for (const std::int32_t f : surfaces[s].facets)
      for (const NodeId v : mesh.facets[f])
        if (owner[v] < 0) owner[v] = s;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e])
      if (owner[v] < 0) owner[v] = count + mesh.element_body[e];
  for (NodeId v = 1; v < static_cast<NodeId>(mesh.points.size()); ++v) {
    // A node of no element belongs to the first body, so that numbers stay as they are.
    const std::int32_t o = owner[v] < 0 ? count : owner[v];
    (o < count ? owners.surface[o] : owners.volume[o - count]).push_back(v);
  }
  return owners;
}

void write_names(const SimplexMesh<3>& mesh, Writer& w) {
  const std::size_t bodies = mesh.bodies.size();
  w.text("$PhysicalNames\n" + std::to_string(bodies + mesh.groups.size()) + "\n");
  for (std::size_t b = 0; b < bodies; ++b)
    w.text("3 " + std::to_string(b + 1) + " \"" + quotable(mesh.bodies[b]) + "\"\n");
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    w.text("2 " + std::to_string(bodies + g + 1) + " \"" + quotable(mesh.groups[g]) + "\"\n");
  w.text("$EndPhysicalNames\n");
}

void write_entities(const SimplexMesh<3>& mesh, const std::vector<SurfaceEntity>& surfaces,
                    Writer& w) {
  w.text("$Entities\n");
  w.size(0);
  w.size(0);
  w.size(surfaces.size());
  w.size(mesh.bodies.size());
  w.end();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    Box box;
    for (const std::int32_t f : surfaces[s].facets)
      for (const NodeId v : mesh.facets[f]) box.add(mesh.points[v]);
    w.integer(static_cast<std::int32_t>(s + 1));
    box.write(w);
    w.size(1);
    w.integer(static_cast<std::int32_t>(mesh.bodies.size()) + surfaces[s].group + 1);
    w.size(0);
    w.end();
  }
  std::vector<Box> boxes(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    for (const NodeId v : mesh.elements[e]) boxes[mesh.element_body[e]].add(mesh.points[v]);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    w.integer(static_cast<std::int32_t>(b + 1));
    boxes[b].write(w);
    w.size(1);
    w.integer(static_cast<std::int32_t>(b + 1));
    w.size(0);
    w.end();
  }
  w.close();
  w.text("$EndEntities\n");
}

void write_nodes(const SimplexMesh<3>& mesh, const Owners& owners, Writer& w) {
  w.text("$Nodes\n");
  w.size(owners.surface.size() + owners.volume.size());
  w.size(mesh.node_count());
  w.size(1);
  w.size(mesh.node_count());
  w.end();
  const auto block = [&](int dimension, std::size_t index, const std::vector<NodeId>& nodes) {
    w.integer(dimension);
    w.integer(static_cast<std::int32_t>(index + 1));
    w.integer(0);
    w.size(nodes.size());
    w.end();
    for (const NodeId v : nodes) {
      w.size(static_cast<std::uint64_t>(v));
      w.end();
    }
    for (const NodeId v : nodes) {
      for (int i = 0; i < 3; ++i) w.real(mesh.points[v][i]);
      w.end();
    }
  };
  for (std::size_t s = 0; s < owners.surface.size(); ++s) block(2, s, owners.surface[s]);
  for (std::size_t b = 0; b < owners.volume.size(); ++b) block(3, b, owners.volume[b]);
  w.close();
  w.text("$EndNodes\n");
}

/// Returns the tags of the tetrahedra.
std::vector<std::int32_t> write_elements(const SimplexMesh<3>& mesh,
                                         const std::vector<SurfaceEntity>& surfaces, Writer& w) {
  std::vector<std::vector<std::int32_t>> by_body(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    by_body[mesh.element_body[e]].push_back(static_cast<std::int32_t>(e));

  w.text("$Elements\n");
  const std::uint64_t count = mesh.facets.size() + mesh.elements.size();
  w.size(surfaces.size() + by_body.size());
  w.size(count);
  w.size(1);
  w.size(count);
  w.end();
  std::vector<std::int32_t> tags(mesh.elements.size());
  std::uint64_t tag = 0;
  const auto block = [&](int dimension, std::size_t index, int type,
                         const std::vector<std::int32_t>& ids, const auto& simplices) {
    w.integer(dimension);
    w.integer(static_cast<std::int32_t>(index + 1));
    w.integer(type);
    w.size(ids.size());
    w.end();
    for (const std::int32_t id : ids) {
      w.size(++tag);
      if (dimension == 3) tags[id] = static_cast<std::int32_t>(tag);
      for (const NodeId v : simplices[id]) w.size(static_cast<std::uint64_t>(v));
      w.end();
    }
  };
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    block(2, s, kTriangle, surfaces[s].facets, mesh.facets);
  for (std::size_t b = 0; b < by_body.size(); ++b)
    block(3, b, kTetrahedron, by_body[b], mesh.elements);
  w.close();
  w.text("$EndElements\n");
  return tags;
}

/// `value(i, component)` of what has the number `tag(i)`, i from 1; the components are 1, 3 or 9,
/// all that Gmsh knows.
template <class Tag, class Value>
void write_data(const std::string& section, const std::string& name, int components,
                std::size_t count, Writer& w, const Tag& tag, const Value& value) {
  w.text("$" + section + "\n1\n\"" + quotable(name) + "\"\n1\n0\n3\n0\n" +
         std::to_string(components) + "\n" + std::to_string(count) + "\n");
  for (std::size_t i = 1; i <= count; ++i) {
    w.integer(tag(i));
    for (int c = 0; c < components; ++c) w.real(value(i, c));
    w.end();
  }
  w.close();
  w.text("$End" + section + "\n");
}

void write_fields(const SimplexMesh<3>& mesh, const MeshFields& fields,
                  const std::vector<std::int32_t>& tags, Writer& w) {
  const auto node = [](std::size_t i) { return static_cast<std::int32_t>(i); };
  if (fields.metric)
    write_data("NodeData", "metric", 9, mesh.node_count(), w, node,
               [&](std::size_t v, int c) { return (*fields.metric)[v](c / 3, c % 3); });
  if (fields.thickness)
    write_data("NodeData", "thickness", 1, mesh.node_count(), w, node,
               [&](std::size_t v, int) { return (*fields.thickness)[v]; });
  for (const NodeField& field : fields.of_nodes)
    write_data(
        "NodeData", field.name, field.components, mesh.node_count(), w, node,
        [&](std::size_t v, int c) {
          return field
              .values[v * static_cast<std::size_t>(field.components) + static_cast<std::size_t>(c)];
        });
  for (const ElementField& field : fields.of_elements)
    write_data(
        "ElementData", field.name, 1, tags.size(), w, [&](std::size_t i) { return tags[i - 1]; },
        [&](std::size_t i, int) { return field.values[i - 1]; });
}

/// Nodes and elements of version 2.2; an element carries its physical tag and its entity. Returns
/// the tags of the tetrahedra.
std::vector<std::int32_t> write_mesh_22(const SimplexMesh<3>& mesh, Writer& w) {
  w.text("$Nodes\n" + std::to_string(mesh.node_count()) + "\n");
  for (std::size_t v = 1; v < mesh.points.size(); ++v) {
    w.size(v);
    for (int i = 0; i < 3; ++i) w.real(mesh.points[v][i]);
    w.end();
  }
  w.text("$EndNodes\n$Elements\n" + std::to_string(mesh.facets.size() + mesh.elements.size()) +
         "\n");
  std::int32_t tag = 0;
  const auto element = [&](int type, std::int32_t physical, std::int32_t entity,
                           const auto& simplex) {
    w.integer(++tag);
    w.integer(type);
    w.integer(2);
    w.integer(physical);
    w.integer(entity);
    for (const NodeId v : simplex) w.integer(v);
    w.end();
  };
  const std::vector<SurfaceEntity> surfaces = surface_entities(mesh);
  const auto bodies = static_cast<std::int32_t>(mesh.bodies.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (const std::int32_t f : surfaces[s].facets)
      element(kTriangle, bodies + surfaces[s].group + 1, static_cast<std::int32_t>(s + 1),
              mesh.facets[f]);
  std::vector<std::int32_t> tags;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    element(kTetrahedron, mesh.element_body[e] + 1, mesh.element_body[e] + 1, mesh.elements[e]);
    tags.push_back(tag);
  }
  w.text("$EndElements\n");
  return tags;
}

}  // namespace

Result<void> write_msh(const SimplexMesh<3>& mesh, const MeshFields& fields,
                       const std::filesystem::path& file, const MshParams& params,
                       const Progress& progress) {
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  {
    Writer w(target->stream(), params.binary);
    w.text(std::string("$MeshFormat\n4.1 ") + (params.binary ? "1" : "0") + " 8\n");
    if (params.binary) {
      w.integer(1);
      w.close();
    }
    w.text("$EndMeshFormat\n");
    write_names(mesh, w);
    const std::vector<SurfaceEntity> surfaces = surface_entities(mesh);
    write_entities(mesh, surfaces, w);
    if (progress.cancelled()) return cancelled_error();
    write_nodes(mesh, owners_of(mesh, surfaces), w);
    progress.report(0.3);
    if (progress.cancelled()) return cancelled_error();
    const std::vector<std::int32_t> tags = write_elements(mesh, surfaces, w);
    progress.report(0.7);
    if (progress.cancelled()) return cancelled_error();
    write_fields(mesh, fields, tags, w);
  }
  if (Result<void> done = target->commit(); !done) return done;
  progress.report(1);
  return {};
}

Result<void> write_msh22(const SimplexMesh<3>& mesh, const MeshFields& fields,
                         const std::filesystem::path& file, const Progress& progress) {
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  {
    Writer w(target->stream(), false);
    w.text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    write_names(mesh, w);
    if (progress.cancelled()) return cancelled_error();
    const std::vector<std::int32_t> tags = write_mesh_22(mesh, w);
    progress.report(0.7);
    if (progress.cancelled()) return cancelled_error();
    write_fields(mesh, fields, tags, w);
  }
  if (Result<void> done = target->commit(); !done) return done;
  progress.report(1);
  return {};
}

}  // namespace lamella
