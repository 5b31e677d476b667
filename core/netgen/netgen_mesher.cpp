#include "core/netgen/netgen_mesher.h"

#include <exception>
#include <mutex>
#include <optional>
#include <ostream>
#include <sstream>
#include <stop_token>

#include "core/optimize/certificate.h"

namespace nglib {
#include <nglib.h>
}
// Exported by the library, in headers that need its private ones.
extern "C" {
void Ng_SetTerminate();
void Ng_UnSetTerminate();
}
namespace netgen {
extern int printmessage_importance;
extern std::ostream* mycout;
extern std::ostream* myerr;
}  // namespace netgen

namespace lamella {
namespace {

std::mutex& library_lock() {
  static std::mutex lock;
  return lock;
}

struct MeshDeleter {
  void operator()(nglib::Ng_Mesh* mesh) const { nglib::Ng_DeleteMesh(mesh); }
};
using LibraryMesh = std::unique_ptr<nglib::Ng_Mesh, MeshDeleter>;

Error failure(const std::string& why) {
  return {Code::failed, "Netgen could not mesh the volume: " + why,
          "The surface may cross or touch itself; try a finer or coarser chord tolerance."};
}

/// Takes what the library prints, and its global settings, for the length of a scope.
class Console {
 public:
  Console() {
    netgen::printmessage_importance = 0;
    netgen::mycout = netgen::myerr = &text_;
    Ng_UnSetTerminate();
  }
  ~Console() {
    netgen::printmessage_importance = importance_;
    netgen::mycout = out_;
    netgen::myerr = err_;
    Ng_UnSetTerminate();
  }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  /// The last error it printed, as a sentence; empty if none.
  std::string complaint() const {
    std::istringstream in(text_.str());
    std::string last;
    for (std::string line; std::getline(in, line);)
      if (const auto at = line.find("ERROR: "); at != std::string::npos) last = line.substr(at + 7);
    return last.empty() ? last : last + ".";
  }

 private:
  std::ostringstream text_;
  int importance_ = netgen::printmessage_importance;
  std::ostream* out_ = netgen::mycout;
  std::ostream* err_ = netgen::myerr;
};

class NetgenMesher final : public VolumeMesher {
 public:
  std::string name() const override { return "Netgen 6.2"; }

  Result<SimplexMesh<3>> generate(const ReferenceSurface<3>& surface,
                                  const Progress& progress) const override {
    if (surface.facets.empty()) return Error{Code::bad_input, "The surface has no triangle.", ""};
    std::scoped_lock guard(library_lock());
    if (progress.cancelled()) return cancelled_error();
    progress.report(0);
    std::optional<SimplexMesh<3>> mesh;
    std::string why;
    {
      Console console;
      std::stop_callback stop(progress.stop_token(), [] { Ng_SetTerminate(); });
      try {
        mesh = fill(surface);
        why = console.complaint();
      } catch (const std::exception& e) {
        why = e.what();
      } catch (...) {
        why = "it threw an unknown exception.";
      }
    }
    if (progress.cancelled()) return cancelled_error();
    if (!mesh) return failure(why);
    if (mesh->elements.empty()) return failure(why.empty() ? "it gave no tetrahedron." : why);
    if (auto valid = certify<3>(*mesh, surface); !valid) return failure(valid.error().message);
    progress.report(1);
    return std::move(*mesh);
  }

 private:
  static SimplexMesh<3> fill(const ReferenceSurface<3>& surface) {
    // The library drops points without a facet and renumbers: give it the used ones only.
    const auto n = static_cast<NodeId>(surface.points.size());
    std::vector<int> number(n, 0);
    std::vector<NodeId> node(1, 0);  // [library number] our node
    for (const auto& f : surface.facets)
      for (const auto v : f) number[v] = 1;
    LibraryMesh library(nglib::Ng_NewMesh());
    Vec<3> lo = surface.points[surface.facets[0][0]], hi = lo;
    for (NodeId v = 0; v < n; ++v) {
      if (!number[v]) continue;
      number[v] = static_cast<int>(node.size());
      node.push_back(v + 1);
      Vec<3> x = surface.points[v];
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
    SimplexMesh<3> mesh;
    if (nglib::Ng_GenerateVolumeMesh(library.get(), &parameters) != nglib::NG_OK) return mesh;

    mesh.points.insert(mesh.points.end(), surface.points.begin(), surface.points.end());
    const int points = nglib::Ng_GetNP(library.get());
    for (int i = static_cast<int>(node.size()); i <= points; ++i) {
      Vec<3> x;
      nglib::Ng_GetPoint(library.get(), i, x.data());
      node.push_back(static_cast<NodeId>(mesh.points.size()));
      mesh.points.push_back(x);
    }
    const int elements = nglib::Ng_GetNE(library.get());
    mesh.elements.reserve(elements);
    for (int i = 1; i <= elements; ++i) {
      int v[NG_VOLUME_ELEMENT_MAXPOINTS] = {};
      nglib::Ng_GetVolumeElement(library.get(), i, v);
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
};

}  // namespace

std::unique_ptr<VolumeMesher> netgen_mesher() { return std::make_unique<NetgenMesher>(); }

}  // namespace lamella
