#include "core/io/open_foam.h"

#include <algorithm>
#include <cctype>
#include <numeric>

#include "core/base/atomic_file.h"
#include "core/base/version.h"
#include "core/io/facet_sides.h"
#include "core/io/words.h"
#include "core/mesh/adjacency.h"

namespace lamella {

namespace {

namespace fs = std::filesystem;
using Facet = SimplexMesh<3>::Facet;

constexpr const char* kControl =
    "application     simpleFoam;\nstartFrom       startTime;\nstartTime       0;\n"
    "stopAt          endTime;\nendTime         1;\ndeltaT          1;\n"
    "writeControl    timeStep;\nwriteInterval   1;\n";
constexpr const char* kSchemes =
    "ddtSchemes { default steadyState; }\ngradSchemes { default Gauss linear; }\n"
    "divSchemes { default Gauss upwind; }\nlaplacianSchemes { default Gauss linear limited 0.5; }\n"
    "interpolationSchemes { default linear; }\nsnGradSchemes { default limited 0.5; }\n";
constexpr const char* kSolution = "solvers {}\nSIMPLE { nNonOrthogonalCorrectors 2; }\n";

std::string header(const std::string& type, const std::string& place, const std::string& object,
                   const std::string& note = {}) {
  return "FoamFile\n{\n    version     2.0;\n    format      ascii;\n    class       " + type +
         ";\n" + (note.empty() ? "" : "    note        \"" + note + "\";\n") +
         "    location    \"" + place + "\";\n    object      " + object + ";\n}\n\n";
}

/// The faces as OpenFOAM numbers them.
struct Faces {
  std::vector<Facet> nodes;
  std::vector<std::int32_t> owner;
  std::vector<std::int32_t> neighbor;  ///< of the inner faces, which come first
  struct Patch {
    std::string name;
    std::size_t first = 0, count = 0;
  };
  std::vector<Patch> patches;
  struct Zone {
    std::string name;
    std::vector<std::int32_t> faces;
    std::vector<bool> flipped;
  };
  std::vector<Zone> zones;
};

bool same_sense(const Facet& a, const Facet& b) {
  const auto k = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[(k + 1) % 3] == a[1];
}

/// Inner faces by ascending owner, then neighbor; each points from the owner to the neighbor.
void number_inner(const SimplexMesh<3>& mesh, Faces& out) {
  struct Inner {
    std::int32_t owner, neighbor;
    std::uint32_t local;
  };
  std::vector<Inner> inner;
  inner.reserve(2 * mesh.elements.size());
  {
    const auto uses = face_uses<3>(mesh.elements, mesh.points.size());
    for_each_face<3>(uses, [&](std::size_t first, std::size_t last) {
      if (last - first == 2)
        inner.push_back({uses[first].element, uses[first + 1].element, uses[first].local});
    });
  }
  std::sort(inner.begin(), inner.end(), [](const Inner& a, const Inner& b) {
    return std::pair(a.owner, a.neighbor) < std::pair(b.owner, b.neighbor);
  });
  for (const Inner& face : inner) {
    out.nodes.push_back(opposite_facet<3>(mesh.elements[face.owner], static_cast<int>(face.local)));
    out.owner.push_back(face.owner);
    out.neighbor.push_back(face.neighbor);
  }
}

Faces number_faces(const SimplexMesh<3>& mesh) {
  Faces out;
  number_inner(mesh, out);
  const auto inner = static_cast<std::int32_t>(out.neighbor.size());
  const auto number_of = [&](std::int32_t owner, std::int32_t neighbor) {
    auto at = std::lower_bound(out.owner.begin(), out.owner.begin() + inner, owner);
    while (out.neighbor[static_cast<std::size_t>(at - out.owner.begin())] != neighbor) ++at;
    return static_cast<std::int32_t>(at - out.owner.begin());
  };
  const std::vector<FacetSide> sides = facet_sides(mesh);
  std::vector<std::vector<std::size_t>> of_group(mesh.groups.size());
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f].element >= 0) of_group[mesh.facet_group[f]].push_back(f);
  for (std::size_t g = 0; g < of_group.size(); ++g) {
    Faces::Patch patch{mesh.groups[g], out.owner.size(), 0};
    Faces::Zone zone{mesh.groups[g], {}, {}};
    for (const std::size_t f : of_group[g]) {
      const FacetSide& side = sides[f];
      if (side.other < 0) {
        out.nodes.push_back(opposite_facet<3>(mesh.elements[side.element], side.local));
        out.owner.push_back(side.element);
        ++patch.count;
      } else {
        zone.faces.push_back(
            number_of(std::min(side.element, side.other), std::max(side.element, side.other)));
        zone.flipped.push_back(!same_sense(mesh.facets[f], out.nodes[zone.faces.back()]));
      }
    }
    if (patch.count > 0) out.patches.push_back(std::move(patch));
    if (!zone.faces.empty()) out.zones.push_back(std::move(zone));
  }
  return out;
}

template <class List>
void write_labels(TextBuilder& out, const List& labels) {
  out << labels.size() << "\n(\n";
  for (const auto label : labels) out << label << '\n';
  out << ")\n";
}

std::string zones_text(const SimplexMesh<3>& mesh) {
  std::vector<std::vector<std::int32_t>> cells(mesh.bodies.size());
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    cells[mesh.element_body[e]].push_back(static_cast<std::int32_t>(e));
  TextBuilder out;
  out << header("regIOobject", "constant/polyMesh", "cellZones") << cells.size() << "\n(\n";
  for (std::size_t b = 0; b < cells.size(); ++b) {
    out << mesh.bodies[b] << "\n{\n    type cellZone;\n    cellLabels List<label>\n";
    write_labels(out, cells[b]);
    out << ";\n}\n";
  }
  out << ")\n";
  return out.text();
}

std::string zones_text(const Faces& faces) {
  TextBuilder out;
  out << header("regIOobject", "constant/polyMesh", "faceZones") << faces.zones.size() << "\n(\n";
  for (const Faces::Zone& zone : faces.zones) {
    out << zone.name << "\n{\n    type faceZone;\n    faceLabels List<label>\n";
    write_labels(out, zone.faces);
    out << ";\n    flipMap List<bool>\n" << zone.flipped.size() << "\n(\n";
    for (const bool flipped : zone.flipped) out << (flipped ? "1\n" : "0\n");
    out << ")\n;\n}\n";
  }
  out << ")\n";
  return out.text();
}

std::string boundary_text(const Faces& faces) {
  TextBuilder out;
  out << header("polyBoundaryMesh", "constant/polyMesh", "boundary") << faces.patches.size()
      << "\n(\n";
  for (const Faces::Patch& patch : faces.patches) {
    out << "    " << patch.name << "\n    {\n        type " << patch_type(patch.name) << ";\n";
    if (patch_type(patch.name) == "wall") out << "        inGroups 1(wall);\n";
    out << "        nFaces " << patch.count << ";\n        startFace " << patch.first
        << ";\n    }\n";
  }
  out << ")\n";
  return out.text();
}

/// What a field says of its patches.
void write_patches(TextBuilder& out, const Faces& faces, const char* otherwise) {
  out << "boundaryField\n{\n";
  for (const Faces::Patch& patch : faces.patches)
    out << "    " << patch.name << "\n    {\n        type "
        << (patch_type(patch.name) == "symmetry" ? "symmetry" : otherwise) << ";\n    }\n";
  out << "}\n";
}

std::string alpha_text(const std::string& body, const std::vector<double>& ratios,
                       const Faces& faces) {
  TextBuilder out;
  out << header("volScalarField", "0", "alpha." + body)
      << "dimensions [0 0 0 0 0 0 0];\n\ninternalField nonuniform List<scalar>\n";
  write_labels(out, ratios);
  out << ";\n\n";
  write_patches(out, faces, "zeroGradient");
  return out.text();
}

std::string metric_text(const MetricField<3>& metric, const Faces& faces) {
  TextBuilder out;
  out << header("pointSymmTensorField", "0", "metric")
      << "dimensions [0 -2 0 0 0 0 0];\n\ninternalField nonuniform List<symmTensor>\n"
      << metric.size() - 1 << "\n(\n";
  for (std::size_t v = 1; v < metric.size(); ++v) {
    const Metric<3>& m = metric[v];
    out << '(' << m(0, 0) << ' ' << m(0, 1) << ' ' << m(0, 2) << ' ' << m(1, 1) << ' ' << m(1, 2)
        << ' ' << m(2, 2) << ")\n";
  }
  out << ")\n;\n\n";
  write_patches(out, faces, "calculated");
  return out.text();
}

Error folder_error(const fs::path& folder, const std::error_code& ec) {
  return {Code::io, "\"" + folder.string() + "\" cannot be written (" + ec.message() + ").",
          "Check the permissions of the folder and the space on the disk."};
}

Result<void> write_poly_mesh(const SimplexMesh<3>& mesh, const Faces& faces, const fs::path& folder,
                             const Progress& progress) {
  const std::string place = "constant/polyMesh";
  TextBuilder text;
  text << header("vectorField", place, "points", "Lamella " + version() + ", lengths in m")
       << mesh.node_count() << "\n(\n";
  for (std::size_t v = 1; v < mesh.points.size(); ++v)
    text << '(' << mesh.points[v][0] << ' ' << mesh.points[v][1] << ' ' << mesh.points[v][2]
         << ")\n";
  text << ")\n";
  if (auto done = write_file(folder / "points", text.text()); !done) return done;
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.4);

  text = {};
  text << header("faceList", place, "faces") << faces.nodes.size() << "\n(\n";
  for (const Facet& f : faces.nodes)
    text << "3(" << f[0] - 1 << ' ' << f[1] - 1 << ' ' << f[2] - 1 << ")\n";
  text << ")\n";
  if (auto done = write_file(folder / "faces", text.text()); !done) return done;
  if (progress.cancelled()) return cancelled_error();
  progress.report(0.6);

  const std::string note = "nPoints:" + std::to_string(mesh.node_count()) +
                           "  nCells:" + std::to_string(mesh.elements.size()) +
                           "  nFaces:" + std::to_string(faces.nodes.size()) +
                           "  nInternalFaces:" + std::to_string(faces.neighbor.size());
  for (const auto& [name, labels] :
       {std::pair("owner", &faces.owner), std::pair("neighbour", &faces.neighbor)}) {
    text = {};
    text << header("labelList", place, name, note);
    write_labels(text, *labels);
    if (auto done = write_file(folder / name, text.text()); !done) return done;
  }
  if (progress.cancelled()) return cancelled_error();
  if (auto done = write_file(folder / "boundary", boundary_text(faces)); !done) return done;
  if (auto done = write_file(folder / "cellZones", zones_text(mesh)); !done) return done;
  return write_file(folder / "faceZones", zones_text(faces));
}

}  // namespace

std::string patch_type(const std::string& group) {
  std::string name = group;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.find("symm") != name.npos) return "symmetry";
  for (const char* open : {"gate", "vent", "inlet", "outlet", "opening"})
    if (name.find(open) != name.npos) return "patch";
  return "wall";
}

Result<void> write_open_foam(const SimplexMesh<3>& mesh, const MeshFields& fields,
                             const fs::path& file, const Progress& progress) {
  const fs::path root = file.has_parent_path() ? file.parent_path() : ".";
  const fs::path mesh_folder = root / "constant" / "polyMesh";
  const fs::path fresh = root / "constant" / ".polyMesh.part";
  std::error_code ec;
  fs::remove_all(fresh, ec);
  for (const fs::path& folder : {fresh, root / "0", root / "system"})
    if (fs::create_directories(folder, ec); ec) return folder_error(folder, ec);
  const Faces faces = number_faces(mesh);
  if (progress.cancelled()) return fs::remove_all(fresh, ec), cancelled_error();
  progress.report(0.2);
  if (Result<void> done = write_poly_mesh(mesh, faces, fresh, progress.portion(0.2, 0.8)); !done)
    return fs::remove_all(fresh, ec), done.error();
  fs::remove_all(mesh_folder, ec);
  if (fs::rename(fresh, mesh_folder, ec); ec) return folder_error(mesh_folder, ec);

  // Fields of an older mesh would not fit this one.
  for (const auto& entry : fs::directory_iterator(root / "0", ec))
    if (const std::string name = entry.path().filename().string();
        name == "metric" || name.rfind("alpha.", 0) == 0)
      fs::remove(entry.path(), ec);
  for (const ElementField& field : fields.of_elements) {
    if (field.name.rfind(kFillingField, 0) != 0) continue;
    const std::string body = field.name.substr(kFillingField.size());
    if (auto done =
            write_file(root / "0" / ("alpha." + body), alpha_text(body, field.values, faces));
        !done)
      return done.error();
  }
  if (fields.metric)
    if (auto done = write_file(root / "0" / "metric", metric_text(*fields.metric, faces)); !done)
      return done.error();
  for (const auto& [name, text] :
       {std::pair("controlDict", kControl), std::pair("fvSchemes", kSchemes),
        std::pair("fvSolution", kSolution)})
    if (const fs::path path = root / "system" / name; !fs::exists(path, ec))
      if (auto done = write_file(path, header("dictionary", "system", name) + text); !done)
        return done.error();
  if (auto done = write_file(file, ""); !done) return done.error();
  return {};
}

}  // namespace lamella
