#include "core/netgen/netgen_mesher.h"

#include <exception>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "core/base/bytes.h"
#include "core/base/child_process.h"
#include "core/optimize/certificate.h"

namespace nglib {
#include <nglib.h>
}
// Exported by the library, in headers that need its private ones.
namespace netgen {
extern int printmessage_importance;
extern std::ostream* mycout;
extern std::ostream* myerr;
}  // namespace netgen

namespace lamella {
namespace {

struct MeshDeleter {
  void operator()(nglib::Ng_Mesh* mesh) const { nglib::Ng_DeleteMesh(mesh); }
};
using LibraryMesh = std::unique_ptr<nglib::Ng_Mesh, MeshDeleter>;

Error failure(const std::string& why) {
  return {Code::failed, "Netgen could not mesh the volume: " + why,
          "The surface may cross or touch itself; try a finer or coarser chord tolerance."};
}

/// The last error the library printed, as a sentence; empty if none.
std::string complaint(const std::string& text) {
  std::istringstream in(text);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (const auto at = line.find("ERROR: "); at != std::string::npos) last = line.substr(at + 7);
  return last.empty() ? last : last + ".";
}

/// The library numbers the used points of a surface from 1, in their order.
std::vector<NodeId> nodes_of_library(const ReferenceSurface<3>& surface) {
  std::vector<char> used(surface.points.size(), 0);
  for (const auto& f : surface.facets)
    for (const auto v : f) used[v] = 1;
  std::vector<NodeId> node(1, 0);  // [library number] node of the mesh
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) node.push_back(static_cast<NodeId>(v) + 1);
  return node;
}

using Tetrahedron = std::array<std::int32_t, 4>;  // library numbers, in the library's order

}  // namespace

std::string run_netgen(const ReferenceSurface<3>& surface) {
  std::ostringstream printed;
  netgen::printmessage_importance = 0;
  netgen::mycout = netgen::myerr = &printed;
  // It drops points without a facet and renumbers: give it the used ones only.
  const std::vector<NodeId> node = nodes_of_library(surface);
  std::vector<int> number(surface.points.size(), 0);
  LibraryMesh library(nglib::Ng_NewMesh());
  Vec<3> lo = surface.points[node[1] - 1], hi = lo;
  for (std::size_t i = 1; i < node.size(); ++i) {
    Vec<3> x = surface.points[node[i] - 1];
    number[node[i] - 1] = static_cast<int>(i);
    lo = lo.cwiseMin(x);
    hi = hi.cwiseMax(x);
    nglib::Ng_AddPoint(library.get(), x.data());
  }
  for (const auto& f : surface.facets) {
    int t[3] = {number[f[0]], number[f[1]], number[f[2]]};
    nglib::Ng_AddSurfaceElement(library.get(), nglib::NG_TRIG, t);
  }

  nglib::Ng_Meshing_Parameters parameters;
  parameters.maxh = (hi - lo).norm();
  parameters.minh = 0;
  parameters.fineness = 0;
  parameters.grading = 0.7;  // sizes grow fast away from the surface: the optimizer refines later
  parameters.optsurfmeshenable = 0;
  parameters.optvolmeshenable = 1;
  parameters.optsteps_2d = 0;
  parameters.optsteps_3d = 1;
  const auto outcome = nglib::Ng_GenerateVolumeMesh(library.get(), &parameters);
  const std::string why = complaint(printed.str());
  const int elements = nglib::Ng_GetNE(library.get());
  if (outcome != nglib::NG_OK || elements == 0)
    throw std::runtime_error(why.empty() ? "it gave no tetrahedron." : why);

  std::vector<Vec<3>> inside;
  const int points = nglib::Ng_GetNP(library.get());
  for (int i = static_cast<int>(node.size()); i <= points; ++i)
    nglib::Ng_GetPoint(library.get(), i, inside.emplace_back().data());
  std::vector<Tetrahedron> tetrahedra;
  for (int i = 1; i <= elements; ++i) {
    int v[NG_VOLUME_ELEMENT_MAXPOINTS] = {};
    nglib::Ng_GetVolumeElement(library.get(), i, v);
    tetrahedra.push_back({v[0], v[1], v[2], v[3]});
  }
  return bytes_of([&](ByteWriter& out) {
    out.array(inside);
    out.array(tetrahedra);
  });
}

namespace {

/// The mesh of the bytes of `run_netgen`, not certified yet.
Result<SimplexMesh<3>> mesh_of(const std::string& bytes, const ReferenceSurface<3>& surface) {
  std::vector<Vec<3>> inside;
  std::vector<Tetrahedron> tetrahedra;
  ByteReader reader(bytes);
  reader.array(inside);
  reader.array(tetrahedra);
  if (!reader.done()) return failure("its answer is cut off.");
  SimplexMesh<3> mesh;
  mesh.points.insert(mesh.points.end(), surface.points.begin(), surface.points.end());
  std::vector<NodeId> node = nodes_of_library(surface);
  for (const Vec<3>& x : inside) {
    node.push_back(static_cast<NodeId>(mesh.points.size()));
    mesh.points.push_back(x);
  }
  mesh.elements.reserve(tetrahedra.size());
  for (const Tetrahedron& v : tetrahedra) {
    for (const std::int32_t i : v)
      if (i < 1 || i >= static_cast<std::int32_t>(node.size()))
        return failure("its tetrahedra name unknown nodes.");
    // The library orders the vertices of a tetrahedron the other way round.
    mesh.elements.push_back({node[v[0]], node[v[2]], node[v[1]], node[v[3]]});
  }
  mesh.element_body.assign(mesh.elements.size(), 0);
  mesh.facets.reserve(surface.facets.size());
  for (const auto& f : surface.facets) mesh.facets.push_back({f[0] + 1, f[1] + 1, f[2] + 1});
  mesh.facet_group.assign(mesh.facets.size(), 0);
  mesh.facet_face = surface.facet_face;
  return mesh;
}

class NetgenMesher final : public VolumeMesher {
 public:
  NetgenMesher(NetgenParams params, NetgenWork work) : params_(params), work_(std::move(work)) {}

  std::string name() const override { return "Netgen 6.2"; }

  Result<SimplexMesh<3>> generate(const ReferenceSurface<3>& surface,
                                  const Progress& progress) const override {
    if (surface.facets.empty()) return Error{Code::bad_input, "The surface has no triangle.", ""};
    progress.report(0);
    Result<std::string> bytes = run_in_child([&](const Progress&) { return work_(surface); },
                                             {.seconds = params_.time_limit}, progress);
    if (!bytes) {
      if (bytes.error().code == Code::cancelled) return bytes.error();
      Error error = failure(bytes.error().message);
      error.code = bytes.error().code;
      if (!bytes.error().hint.empty()) error.hint = bytes.error().hint;
      return error;
    }
    Result<SimplexMesh<3>> mesh = mesh_of(*bytes, surface);
    if (!mesh) return mesh;
    if (auto valid = certify<3>(*mesh, surface); !valid) return failure(valid.error().message);
    progress.report(1);
    return mesh;
  }

 private:
  NetgenParams params_;
  NetgenWork work_;
};

}  // namespace

std::unique_ptr<VolumeMesher> netgen_mesher(const NetgenParams& params, NetgenWork work) {
  return std::make_unique<NetgenMesher>(params, std::move(work));
}

}  // namespace lamella
