#include "core/cad/tessellate.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeFix_ShapeTolerance.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cstdio>

#include "core/cad/occt_progress.h"
#include "core/geometry/edge_table.h"
#include "core/geometry/improve_triangles.h"
#include "core/geometry/self_intersection.h"
#include "core/geometry/soup.h"

namespace lamella {
namespace {

constexpr double kFeatureAngle = 0.35;  // radians between the outward normals of two faces
constexpr double kVolumeTolerance = 3e-3;
constexpr double kKink = 0.6;  // radians between the tangents of two feature curves

Vec<3> to_vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

std::string short_number(double x) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", x);
  return text;
}

/// One CAD edge: the vertices along it by growing parameter, and the faces on its two sides.
struct EdgeRecord {
  std::vector<std::int32_t> nodes;
  std::vector<std::pair<TopoDS_Edge, TopoDS_Face>> sides;
};

/// Joins the triangulations of the faces of one solid through their shared edges.
class Joiner {
 public:
  explicit Joiner(const TopoDS_Shape& solid) {
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
      add_face(TopoDS::Face(it.Current()));
      ++faces_;
    }
    for (const EdgeRecord& edge : edges_) add_feature(edge);
    find_corners();
  }

  ReferenceSurface<3>& surface() { return surface_; }
  std::size_t face_count() const { return static_cast<std::size_t>(faces_); }
  std::size_t missing_faces() const { return missing_; }
  std::size_t torn_edges() const { return torn_; }
  double deviation() const { return deviation_; }

 private:
  std::int32_t add_point(const Vec<3>& p) {
    surface_.points.push_back(p);
    return static_cast<std::int32_t>(surface_.points.size()) - 1;
  }

  std::int32_t vertex(const TopoDS_Vertex& v) {
    const int index = vertex_map_.Add(v);
    if (index > static_cast<int>(vertices_.size())) {
      vertices_.push_back(add_point(to_vec(BRep_Tool::Pnt(v).XYZ())));
    }
    return vertices_[index - 1];
  }

  EdgeRecord& edge_record(const TopoDS_Edge& edge) {
    const int index = edge_map_.Add(edge);
    if (index > static_cast<int>(edges_.size())) edges_.emplace_back();
    return edges_[index - 1];
  }

  void add_face(const TopoDS_Face& oriented) {
    // On a forward face the orientation of a seam edge tells its two sides apart.
    const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull() || mesh->NbTriangles() == 0) {
      ++missing_;
      return;
    }
    const gp_Trsf move = location.Transformation();
    const auto position = [&](int node) {
      return to_vec(mesh->Node(node).Transformed(move).XYZ());
    };
    std::vector<std::int32_t> id(static_cast<std::size_t>(mesh->NbNodes()) + 1, -1);
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(it.Current());
      const Handle(Poly_PolygonOnTriangulation) polygon =
          BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
      if (polygon.IsNull()) continue;
      const int n = polygon->NbNodes();
      if (BRep_Tool::Degenerated(edge)) {
        const std::int32_t apex = vertex(TopExp::FirstVertex(edge));
        for (int k = 1; k <= n; ++k) id[polygon->Node(k)] = apex;
        continue;
      }
      EdgeRecord& record = edge_record(edge);
      record.sides.emplace_back(edge, oriented);
      if (record.nodes.empty()) {
        record.nodes.push_back(vertex(TopExp::FirstVertex(edge)));
        for (int k = 2; k < n; ++k) record.nodes.push_back(add_point(position(polygon->Node(k))));
        record.nodes.push_back(vertex(TopExp::LastVertex(edge)));
      }
      if (static_cast<int>(record.nodes.size()) != n) {
        ++torn_;
        continue;
      }
      for (int k = 1; k <= n; ++k) id[polygon->Node(k)] = record.nodes[k - 1];
    }
    for (int node = 1; node <= mesh->NbNodes(); ++node) {
      if (id[node] < 0) id[node] = add_point(position(node));
    }
    const bool turn = (oriented.Orientation() == TopAbs_REVERSED) != move.IsNegative();
    for (int t = 1; t <= mesh->NbTriangles(); ++t) {
      int a = 0, b = 0, c = 0;
      mesh->Triangle(t).Get(a, b, c);
      if (turn) std::swap(b, c);
      // At a degenerated edge two nodes are one point: the triangle vanishes.
      if (id[a] == id[b] || id[b] == id[c] || id[c] == id[a]) continue;
      surface_.facets.push_back({id[a], id[b], id[c]});
      surface_.facet_face.push_back(faces_);
    }
    measure_deviation(face, mesh, move);
  }

  /// Distance of the exact surface to the plane of each triangle, at its center and edge middles.
  void measure_deviation(const TopoDS_Face& face, const Handle(Poly_Triangulation) & mesh,
                         const gp_Trsf& move) {
    if (!mesh->HasUVNodes()) return;
    const BRepAdaptor_Surface exact(face, Standard_False);
    if (exact.GetType() == GeomAbs_Plane) return;
    for (int t = 1; t <= mesh->NbTriangles(); ++t) {
      int n[3];
      mesh->Triangle(t).Get(n[0], n[1], n[2]);
      Vec<3> p[3];
      gp_XY uv[3];
      for (int k = 0; k < 3; ++k) {
        p[k] = to_vec(mesh->Node(n[k]).Transformed(move).XYZ());
        uv[k] = mesh->UVNode(n[k]).XY();
      }
      const Vec<3> normal = (p[1] - p[0]).cross(p[2] - p[0]).stableNormalized();
      const gp_XY samples[4] = {(uv[0] + uv[1] + uv[2]) / 3, (uv[0] + uv[1]) / 2,
                                (uv[1] + uv[2]) / 2, (uv[2] + uv[0]) / 2};
      for (const gp_XY& s : samples) {
        const Vec<3> x = to_vec(exact.Value(s.X(), s.Y()).XYZ());
        deviation_ = std::max(deviation_, std::abs(normal.dot(x - p[0])));
      }
    }
  }

  /// Outward normal of a face at the fraction s of an edge; zero where the surface has none.
  static Vec<3> normal_at(const TopoDS_Edge& edge, const TopoDS_Face& face, double s) {
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve =
        BRep_Tool::CurveOnSurface(edge, TopoDS::Face(face.Oriented(TopAbs_FORWARD)), first, last);
    if (curve.IsNull()) return Vec<3>::Zero();
    const gp_Pnt2d uv = curve->Value(first + s * (last - first));
    gp_Pnt p;
    gp_Vec du, dv;
    BRepAdaptor_Surface(face, Standard_False).D1(uv.X(), uv.Y(), p, du, dv);
    const Vec<3> u = to_vec(du.XYZ());
    const Vec<3> v = to_vec(dv.XYZ());
    const Vec<3> n = u.cross(v);
    if (n.norm() <= 1e-9 * u.norm() * v.norm()) return Vec<3>::Zero();
    return face.Orientation() == TopAbs_REVERSED ? Vec<3>(-n.normalized()) : Vec<3>(n.normalized());
  }

  static bool is_sharp(const EdgeRecord& edge) {
    if (edge.sides.size() != 2) return true;
    const auto& [e, f] = edge.sides[0];
    const auto& [d, g] = edge.sides[1];
    for (const double s : {0.05, 0.275, 0.5, 0.725, 0.95}) {
      const Vec<3> m = normal_at(e, f, s);
      const Vec<3> n = normal_at(d, g, s);
      if (std::atan2(m.cross(n).norm(), m.dot(n)) > kFeatureAngle) return true;
    }
    return false;
  }

  void add_feature(const EdgeRecord& edge) {
    if (edge.nodes.empty() || !is_sharp(edge)) return;
    const BRepAdaptor_Curve curve(edge.sides[0].first);
    gp_Pnt p;
    gp_Vec first, last;
    curve.D1(curve.FirstParameter(), p, first);
    curve.D1(curve.LastParameter(), p, last);
    const std::size_t n = edge.nodes.size();
    const auto chord = [&](std::size_t i, std::size_t j) -> Vec<3> {
      return surface_.points[edge.nodes[j]] - surface_.points[edge.nodes[i]];
    };
    const bool smooth = first.Magnitude() > 1e-9 && last.Magnitude() > 1e-9;
    feature_ends_.push_back({edge.nodes[0], smooth ? to_vec(first.XYZ()) : chord(0, 1)});
    feature_ends_.push_back(
        {edge.nodes[n - 1], smooth ? Vec<3>(-to_vec(last.XYZ())) : chord(n - 1, n - 2)});
    for (std::size_t k = 0; k + 1 < n; ++k) {
      if (edge.nodes[k] != edge.nodes[k + 1]) {
        surface_.feature_edges.push_back({std::min(edge.nodes[k], edge.nodes[k + 1]),
                                          std::max(edge.nodes[k], edge.nodes[k + 1])});
      }
      // A curve of class C0 kinks between its ends.
      if (k == 0) continue;
      const Vec<3> in = chord(k - 1, k);
      const Vec<3> out = chord(k, k + 1);
      if (std::atan2(in.cross(out).norm(), in.dot(out)) > 1.2 * kKink) {
        surface_.corners.push_back(edge.nodes[k]);
      }
    }
  }

  void find_corners() {
    std::stable_sort(feature_ends_.begin(), feature_ends_.end(),
                     [](const FeatureEnd& x, const FeatureEnd& y) { return x.vertex < y.vertex; });
    for (std::size_t i = 0; i < feature_ends_.size();) {
      std::size_t j = i;
      while (j < feature_ends_.size() && feature_ends_[j].vertex == feature_ends_[i].vertex) ++j;
      bool corner = j - i != 2;
      if (!corner) {
        const Vec<3> in = -feature_ends_[i].tangent;
        const Vec<3>& out = feature_ends_[i + 1].tangent;
        corner = std::atan2(in.cross(out).norm(), in.dot(out)) > kKink;
      }
      if (corner) surface_.corners.push_back(feature_ends_[i].vertex);
      i = j;
    }
    auto& corners = surface_.corners;
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    auto& edges = surface_.feature_edges;
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  }

  struct FeatureEnd {
    std::int32_t vertex;
    Vec<3> tangent;  // along the curve, away from the vertex
  };

  ReferenceSurface<3> surface_;
  TopTools_IndexedMapOfShape vertex_map_, edge_map_;
  std::vector<std::int32_t> vertices_;  // [index in the map - 1]
  std::vector<EdgeRecord> edges_;
  std::vector<FeatureEnd> feature_ends_;
  std::int32_t faces_ = 0;
  std::size_t missing_ = 0;
  std::size_t torn_ = 0;
  double deviation_ = 0;
};

void drop_unused_points(ReferenceSurface<3>& s) {
  std::vector<std::int32_t> id(s.points.size(), -1);
  std::vector<Vec<3>> points;
  for (auto& f : s.facets) {
    for (std::int32_t& v : f) {
      if (id[v] < 0) {
        id[v] = static_cast<std::int32_t>(points.size());
        points.push_back(s.points[v]);
      }
      v = id[v];
    }
  }
  s.points = std::move(points);
  std::erase_if(s.feature_edges, [&](const auto& e) { return id[e[0]] < 0 || id[e[1]] < 0; });
  for (auto& e : s.feature_edges) {
    e = {std::min(id[e[0]], id[e[1]]), std::max(id[e[0]], id[e[1]])};
  }
  std::erase_if(s.corners, [&](std::int32_t c) { return id[c] < 0; });
  for (std::int32_t& c : s.corners) c = id[c];
  std::sort(s.corners.begin(), s.corners.end());
}

/// What is wrong with the triangles of a solid; empty when nothing is.
std::string finding(Joiner& joined, const Progress& progress) {
  ReferenceSurface<3>& s = joined.surface();
  if (joined.missing_faces() > 0) {
    return std::to_string(joined.missing_faces()) + " of its faces cannot be triangulated";
  }
  if (joined.torn_edges() > 0) {
    return std::to_string(joined.torn_edges()) + " of its edges are torn";
  }
  if (s.facets.empty()) return "it has no faces";
  if (enclosed_measure(s) < 0) {  // an inside-out solid
    for (auto& f : s.facets) std::swap(f[1], f[2]);
  }
  if (Result<void> closed = check_closed(s); !closed) return closed.error().message;
  std::size_t crowded = 0;
  for_each_edge(edge_uses(s.facets),
                [&](std::span<const EdgeUse> uses) { crowded += uses.size() > 2 ? 1 : 0; });
  if (crowded > 0) return "more than two facets meet at " + std::to_string(crowded) + " edges";
  if (const SelfIntersections x = find_self_intersections(s, progress); x.pairs > 0) {
    return "its surface crosses itself at " + std::to_string(x.pairs) +
           " places, the first near (" + short_number(x.place[0]) + ", " +
           short_number(x.place[1]) + ", " + short_number(x.place[2]) + ")";
  }
  return {};
}

/// Takes the needles out where the surface stays sound; returns how far it may have moved, mm.
double improve(ReferenceSurface<3>& surface, double chord, const Progress& progress) {
  ImproveParams params;
  params.tolerance = 0.04 * chord;
  params.shortest_edge = 2 * chord;
  ReferenceSurface<3> better = surface;
  improve_triangles(better, params, progress);
  if (!check_closed(better).ok() || find_self_intersections(better, progress).pairs > 0) return 0;
  surface = std::move(better);
  return params.tolerance;
}

struct Attempt {
  IMeshTools_MeshAlgoType algorithm;
  double finer;  // share of the chord tolerance
};

// Delabella is the quick one, but loses points inside some faces; Watson is a second opinion.
constexpr Attempt kAttempts[] = {
    {IMeshTools_MeshAlgoType_Delabella, 1},    {IMeshTools_MeshAlgoType_Watson, 1},
    {IMeshTools_MeshAlgoType_Delabella, 0.5},  {IMeshTools_MeshAlgoType_Watson, 0.5},
    {IMeshTools_MeshAlgoType_Delabella, 0.25}, {IMeshTools_MeshAlgoType_Watson, 0.25},
    {IMeshTools_MeshAlgoType_Delabella, 0.1},  {IMeshTools_MeshAlgoType_Watson, 0.1}};

constexpr std::size_t kMaxRetryFacets = 200'000;

double diagonal(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, Standard_False);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

}  // namespace

Result<Part> tessellate(const TopoDS_Shape& solid, SolidInfo info, const LoadParams& params,
                        Triangles& rough, const Progress& progress) {
  Part part;
  part.name = info.name;
  part.color = info.color;
  part.notes = std::move(info.notes);
  GProp_GProps props;
  BRepGProp::VolumeProperties(solid, props);
  part.cad_volume = std::abs(props.Mass());

  const double asked = params.chord_tolerance.value_or(1e-3 * diagonal(solid));
  const double chord = tessellation_share * asked;
  rough = {};
  std::string problem;
  for (const Attempt& attempt : kAttempts) {
    IMeshTools_Parameters mesh;
    mesh.MeshAlgo = attempt.algorithm;
    mesh.Deflection = chord * attempt.finer;
    mesh.DeflectionInterior = mesh.Deflection;
    mesh.Angle = params.angle_tolerance;
    mesh.AngleInterior = params.angle_tolerance;
    mesh.MinSize = 0.1 * mesh.Deflection;
    mesh.AllowQualityDecrease = Standard_True;
    // Short edges between vertices of a wide tolerance stay straight however fine the triangles.
    if (attempt.finer < 1) ShapeFix_ShapeTolerance().LimitTolerance(solid, 0, 1e-3 * chord);
    BRepTools::Clean(solid);
    Handle(OcctProgress) bridge = new OcctProgress(progress.portion(0, 0.9));
    const BRepMesh_IncrementalMesh run(solid, mesh, bridge->Start());
    if (progress.cancelled()) return cancelled_error();
    Joiner joined(solid);
    std::string here = finding(joined, progress);
    if (progress.cancelled()) return cancelled_error();
    if (here.empty() && joined.deviation() > 1.5 * chord) {
      here = "its triangles lie " + short_number(joined.deviation()) + " mm off the exact surface";
    }
    const double off = enclosed_measure(joined.surface()) / part.cad_volume - 1;
    if (here.empty() && std::abs(off) > kVolumeTolerance) {
      here = "its triangles enclose a volume that is " + short_number(100 * off) + " % off";
    }
    if (problem.empty()) problem = here;
    if (!here.empty()) {
      if (rough.facets.empty()) rough = {joined.surface().points, joined.surface().facets};
      // Finer triangles of a large model that crosses itself take minutes and rarely help.
      if (joined.surface().facets.size() > kMaxRetryFacets) break;
      continue;
    }

    rough = {};
    part.surface = std::move(joined.surface());
    drop_unused_points(part.surface);
    const double moved = improve(part.surface, asked, progress);
    if (progress.cancelled()) return cancelled_error();
    // Healing may have changed the faces.
    if (info.face_colors.size() != joined.face_count())
      info.face_colors.assign(joined.face_count(), {-1, -1, -1});
    for (const auto& color : info.face_colors) part.surface.faces.push_back({"", color});
    part.chord_error = std::max(mesh.Deflection, joined.deviation()) + moved;
    if (attempt.finer < 1) {
      part.notes.push_back("Tessellated with a chord tolerance of " +
                           short_number(mesh.Deflection) + " mm, as with a coarser one " + problem +
                           ".");
    }
    progress.report(1);
    return part;
  }
  return Error{Code::bad_input, "solid '" + part.name + "': " + problem,
               "Repair the solid in the CAD program, or give a finer chord tolerance."};
}

}  // namespace lamella
