#include "core/cad/sample_parts.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <cmath>
#include <functional>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>

#include "core/base/atomic_file.h"
#include "core/cad/cad_reader.h"
#include "core/cad/occt_guard.h"

namespace lamella {
namespace {

struct Body {
  std::string name;
  TopoDS_Shape shape;
  Quantity_Color color;
};

/// A box between two corners.
TopoDS_Shape box(double x0, double y0, double z0, double x1, double y1, double z1) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x0, y0, z0), gp_Pnt(x1, y1, z1)).Shape();
}

TopoDS_Shape pin(double x, double y, double z0, double z1, double radius) {
  return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, z0), gp::DZ()), radius, z1 - z0).Shape();
}

TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_Fuse run(a, b);
  if (run.HasErrors()) throw Standard_Failure("fuse");
  run.SimplifyResult();
  return run.Shape();
}

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_Cut run(a, b);
  if (run.HasErrors()) throw Standard_Failure("cut");
  return run.Shape();
}

/// Rounds the edges whose two ends and middle satisfy `wanted`.
TopoDS_Shape round(const TopoDS_Shape& shape, double radius,
                   const std::function<bool(const gp_Pnt&)>& wanted) {
  BRepFilletAPI_MakeFillet fillet(shape);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int k = 1; k <= edges.Extent(); ++k) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(k));
    if (BRep_Tool::Degenerated(edge)) continue;
    double first = 0, last = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    bool all = true;
    for (const double s : {0.0, 0.25, 0.5, 1.0}) {
      all = all && wanted(curve->Value(first + s * (last - first)));
    }
    if (all) fillet.Add(radius, edge);
  }
  fillet.Build();
  if (!fillet.IsDone()) throw Standard_Failure("fillet");
  return fillet.Shape();
}

bool near(double a, double b) { return std::abs(a - b) < 1e-6; }

std::vector<Body> plate() {
  const auto corner = [](const gp_Pnt& p) {
    return near(std::abs(p.X()), 30) && near(std::abs(p.Y()), 20);
  };
  TopoDS_Shape s = round(box(-30, -20, 0, 30, 20, 2), 5, corner);
  s = cut(s, pin(15, 0, -1, 3, 4));
  return {{"plate", s, Quantity_NOC_STEELBLUE}};
}

/// 80 x 50 x 20 mm, wall 2 mm, ribs 1.4 mm, four screw bosses.
std::vector<Body> ribbed_tray() {
  const auto column = [](double x, double y) {
    return [=](const gp_Pnt& p) { return near(std::abs(p.X()), x) && near(std::abs(p.Y()), y); };
  };
  const auto level = [](double z) { return [=](const gp_Pnt& p) { return near(p.Z(), z); }; };
  TopoDS_Shape outside = round(box(-40, -25, 0, 40, 25, 20), 5, column(40, 25));
  outside = round(outside, 2.5, level(0));
  TopoDS_Shape inside = round(box(-38, -23, 2, 38, 23, 30), 3, column(38, 23));
  inside = round(inside, 1, level(2));
  TopoDS_Shape tray = cut(outside, inside);

  // Ribs end inside the walls, bosses inside the floor: no faces coincide.
  TopoDS_Shape ribs = box(-39, -0.7, 1, 39, 0.7, 9);
  for (const double x : {-13.0, 13.0}) ribs = fuse(ribs, box(x - 0.7, -24, 1, x + 0.7, 24, 9));
  tray = fuse(tray, ribs);
  for (const double x : {-27.0, 27.0}) {
    for (const double y : {-12.5, 12.5}) {
      tray = fuse(tray, pin(x, y, 1, 14, 4));
    }
  }
  // The foot of each boss: a circle on the floor.
  tray = round(tray, 0.8, [](const gp_Pnt& p) {
    return near(p.Z(), 2) && near(std::hypot(std::abs(p.X()) - 27, std::abs(p.Y()) - 12.5), 4);
  });
  for (const double x : {-27.0, 27.0}) {
    for (const double y : {-12.5, 12.5}) tray = cut(tray, pin(x, y, 3.5, 15, 2));
  }
  // A cable slot in one wall.
  tray = cut(tray, box(37, -14, 12, 41, -6, 21));
  return {{"ribbed tray", tray, Quantity_NOC_ORANGE}};
}

/// A doubly curved shell 2 mm thick: an arc of radius 50 turned about an axis 30 behind its center.
std::vector<Body> curved_shell() {
  const auto at = [](double radius, double angle) {
    return gp_Pnt(30 + radius * std::cos(angle), 0, radius * std::sin(angle));
  };
  constexpr double kHalf = 0.7;
  const auto arc = [&](double radius, double from, double to) {
    return BRepBuilderAPI_MakeEdge(
               GC_MakeArcOfCircle(at(radius, from), at(radius, 0), at(radius, to)).Value())
        .Edge();
  };
  BRepBuilderAPI_MakeWire outline;
  outline.Add(arc(50, -kHalf, kHalf));
  outline.Add(BRepBuilderAPI_MakeEdge(at(50, kHalf), at(48, kHalf)).Edge());
  outline.Add(arc(48, kHalf, -kHalf));
  outline.Add(BRepBuilderAPI_MakeEdge(at(48, -kHalf), at(50, -kHalf)).Edge());
  const TopoDS_Shape section = BRepBuilderAPI_MakeFace(outline.Wire(), Standard_True).Shape();
  const TopoDS_Shape shell =
      BRepPrimAPI_MakeRevol(section, gp_Ax1(gp::Origin(), gp::DZ()), 0.9).Shape();
  return {{"curved shell", shell, Quantity_NOC_SEAGREEN}};
}

std::vector<Body> t_junction() {
  TopoDS_Shape s = fuse(box(-20, -30, 0, 20, 30, 3), box(-1, -30, 2, 1, 30, 25));
  s = round(s, 1, [](const gp_Pnt& p) { return near(std::abs(p.X()), 1) && near(p.Z(), 3); });
  return {{"t junction", s, Quantity_NOC_TOMATO}};
}

/// A tube that winds through a cube of 60 mm, and the rest of the cube.
std::vector<Body> twisted_tube() {
  // Two S-bends at right angles to each other, arcs of radius 12 that turn by 60 degrees.
  constexpr double kRadius = 12;
  const double aside = kRadius / 2;
  const double up = kRadius * std::sqrt(3.0) / 2;
  BRepBuilderAPI_MakeWire path;
  gp_Pnt here(-aside, -aside, 0);
  const auto line_to = [&](const gp_Pnt& next) {
    path.Add(BRepBuilderAPI_MakeEdge(here, next).Edge());
    here = next;
  };
  const auto arc_by = [&](const gp_Vec& tangent, const gp_Vec& step) {
    const gp_Pnt next = here.Translated(step);
    path.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(here, tangent, next).Value()).Edge());
    here = next;
  };
  const double straight = 30 - 2 * up;
  line_to(here.Translated(gp_Vec(0, 0, straight)));
  for (const gp_Vec& side : {gp_Vec(1, 0, 0), gp_Vec(0, 1, 0)}) {
    const gp_Vec step = side * aside + gp_Vec(0, 0, up);
    arc_by(gp_Vec(0, 0, 1), step);
    arc_by(side * std::sqrt(3.0) / 2 + gp_Vec(0, 0, 0.5), step);
  }
  line_to(gp_Pnt(here.X(), here.Y(), 60));
  const TopoDS_Wire spine = path.Wire();
  const auto rim = [=](double radius) {
    const gp_Circ circle(gp_Ax2(gp_Pnt(-aside, -aside, 0), gp::DZ()), radius);
    return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
  };
  const TopoDS_Shape full = BRepBuilderAPI_MakeFace(rim(5)).Shape();
  BRepBuilderAPI_MakeFace ring(rim(5));
  ring.Add(TopoDS::Wire(rim(3).Reversed()));
  const TopoDS_Shape tube = BRepOffsetAPI_MakePipe(spine, ring.Shape()).Shape();
  const TopoDS_Shape block =
      cut(box(-30, -30, 0, 30, 30, 60), BRepOffsetAPI_MakePipe(spine, full).Shape());
  return {{"tube", tube, Quantity_NOC_GOLD}, {"block", block, Quantity_NOC_GRAY70}};
}

/// Two walls of 2 mm that meet at an edge.
std::vector<Body> l_profile() {
  return {{"l profile", fuse(box(0, 0, 0, 30, 40, 2), box(0, 0, 0, 2, 40, 30)), Quantity_NOC_PERU}};
}

/// Two walls of 2 mm that cross.
std::vector<Body> cross_junction() {
  return {{"cross junction", fuse(box(-20, 0, -1, 20, 40, 1), box(-1, 0, -20, 1, 40, 20)),
           Quantity_NOC_ORCHID}};
}

/// A wall that grows from 0.4 to 4 mm over 40 mm.
std::vector<Body> wedge() {
  BRepBuilderAPI_MakePolygon section;
  for (const auto& [x, z] : {std::pair{0.0, 0.0}, {40.0, 0.0}, {40.0, 4.0}, {0.0, 0.4}})
    section.Add(gp_Pnt(x, 0, z));
  section.Close();
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(section.Wire(), Standard_True).Shape();
  return {{"wedge", BRepPrimAPI_MakePrism(face, gp_Vec(0, 20, 0)).Shape(), Quantity_NOC_TURQUOISE}};
}

/// A channel 20 mm wide and 2 mm high that winds outward in half circles, as flow tests use.
std::vector<Body> spiral_mold() {
  constexpr double kHalfWidth = 10;
  constexpr double kStep = 15;  // from one half circle's radius to the next: 10 mm between turns
  constexpr int kHalves = 4;
  BRepBuilderAPI_MakeWire outline;
  const auto arc = [&](int half, double aside, bool back) {
    const double center = half % 2 == 0 ? 0 : kStep;
    const double radius = 30 + kStep * half + aside;
    const double side = half % 2 == 0 ? 1 : -1;
    const gp_Pnt from(center + side * radius, 0, 0), to(center - side * radius, 0, 0);
    const gp_Pnt over(center, side * radius, 0);
    outline.Add(BRepBuilderAPI_MakeEdge(
                    GC_MakeArcOfCircle(back ? to : from, over, back ? from : to).Value())
                    .Edge());
  };
  const auto end = [&](double a, double b) {
    outline.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(a, 0, 0), gp_Pnt(b, 0, 0)).Edge());
  };
  for (int half = 0; half < kHalves; ++half) arc(half, kHalfWidth, false);
  const double last = kStep + 30 + kStep * (kHalves - 1);
  end(last + kHalfWidth, last - kHalfWidth);
  for (int half = kHalves - 1; half >= 0; --half) arc(half, -kHalfWidth, true);
  end(30 - kHalfWidth, 30 + kHalfWidth);
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(outline.Wire(), Standard_True).Shape();
  return {{"spiral mold", BRepPrimAPI_MakePrism(face, gp_Vec(0, 0, 2)).Shape(),
           Quantity_NOC_GOLDENROD}};
}

struct Sample {
  const char* name;
  std::vector<Body> (*make)();
};

constexpr Sample kSamples[] = {{"plate", plate},
                               {"ribbed_tray", ribbed_tray},
                               {"curved_shell", curved_shell},
                               {"t_junction", t_junction},
                               {"twisted_tube", twisted_tube},
                               {"l_profile", l_profile},
                               {"cross_junction", cross_junction},
                               {"wedge", wedge},
                               {"spiral_mold", spiral_mold}};

/// Booleans wrap their solid in a compound; a part is the solid itself.
TopoDS_Shape only_solid(const Body& body) {
  TopExp_Explorer it(body.shape, TopAbs_SOLID);
  if (!it.More()) throw Standard_Failure((body.name + " is no solid").c_str());
  const TopoDS_Shape solid = it.Current();
  it.Next();
  if (it.More()) throw Standard_Failure((body.name + " is more than one solid").c_str());
  if (!BRepCheck_Analyzer(solid).IsValid()) {
    throw Standard_Failure((body.name + " is not valid").c_str());
  }
  return solid;
}

/// IGES as most programs write it, as faces that are not sewn.
bool write_document(const Handle(TDocStd_Document) & document, CadFormat format,
                    const std::string& file) {
  if (format == CadFormat::step) {
    STEPCAFControl_Writer writer;
    return writer.Transfer(document, STEPControl_AsIs) &&
           writer.Write(file.c_str()) == IFSelect_RetDone;
  }
  if (format == CadFormat::iges) {
    IGESControl_Controller::Init();
    IGESCAFControl_Writer writer;
    return writer.Transfer(document) && writer.Write(file.c_str());
  }
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(labels);
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TDF_Label& label : labels) builder.Add(all, XCAFDoc_ShapeTool::GetShape(label));
  return BRepTools::Write(all, file.c_str());
}

Result<void> write_bodies(const std::vector<Body>& bodies, const std::filesystem::path& file) {
  STEPCAFControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", "MM");
  Interface_Static::SetCVal("write.step.schema", "AP214IS");
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
  for (const Body& body : bodies) {
    const TDF_Label label = shapes->AddShape(only_solid(body), Standard_False);
    TDataStd_Name::Set(label, TCollection_ExtendedString(body.name.c_str()));
    colors->SetColor(label, body.color, XCAFDoc_ColorSurf);
  }
  Result<AtomicFile> target = AtomicFile::create(file);
  if (!target) return target.error();
  const bool written = write_document(document, cad_format_of(file).value_or(CadFormat::step),
                                      target->temporary().string());
  XCAFApp_Application::GetApplication()->Close(document);
  if (!written) {
    return Error{Code::io, file.string() + ": the CAD file cannot be written",
                 "Check that the folder is writable and has room."};
  }
  return target->commit();
}

}  // namespace

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const Sample& sample : kSamples) names.emplace_back(sample.name);
  return names;
}

Result<void> write_sample(std::string_view name, const std::filesystem::path& file) {
  for (const Sample& sample : kSamples) {
    if (sample.name != name) continue;
    return guarded("sample part '" + std::string(name) + "'",
                   [&] { return write_bodies(sample.make(), file); });
  }
  std::string known;
  for (const Sample& sample : kSamples) {
    known += known.empty() ? "" : ", ";
    known += sample.name;
  }
  return Error{Code::usage, "there is no sample part '" + std::string(name) + "'",
               "Known are: " + known + "."};
}

}  // namespace lamella
