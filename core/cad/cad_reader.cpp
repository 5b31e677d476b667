#include "core/cad/cad_reader.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <ShapeFix_Shape.hxx>
#include <ShapeFix_ShapeTolerance.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XCAFPrs.hxx>
#include <XCAFPrs_DocumentExplorer.hxx>
#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "core/base/atomic_file.h"
#include "core/cad/occt_progress.h"
#include "core/cad/tessellate.h"
#include "core/cad/tessellated_step.h"

namespace lamella {
namespace {

Error bad(const std::filesystem::path& file, const std::string& finding, std::string hint) {
  return {Code::bad_input, file.filename().string() + ": " + finding, std::move(hint)};
}

/// A reading setting of OCCT, put back at the end: they are global to the program.
class Setting {
 public:
  Setting(const char* name, const char* value) : name_(name) {
    if (const char* before = Interface_Static::CVal(name)) before_ = before;
    Interface_Static::SetCVal(name, value);
  }
  ~Setting() { Interface_Static::SetCVal(name_, before_.c_str()); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

 private:
  const char* name_;
  std::string before_;
};

class Document {
 public:
  Document() { XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_); }
  ~Document() {
    if (!document_.IsNull()) XCAFApp_Application::GetApplication()->Close(document_);
  }
  Document(const Document&) = delete;
  Document& operator=(const Document&) = delete;
  Handle(TDocStd_Document) & get() { return document_; }

 private:
  Handle(TDocStd_Document) document_;
};

/// STEP is a text between two fixed words: a missing end is a cut file.
Result<void> check_envelope(const std::filesystem::path& file, const std::string& text) {
  if (text.substr(0, 4096).find("ISO-10303-21") == std::string::npos) {
    return bad(file, "not a STEP file (it does not begin with ISO-10303-21)",
               "Lamella reads AP203, AP214 and AP242; check the file.");
  }
  const std::size_t tail = text.size() > 4096 ? text.size() - 4096 : 64;
  if (text.find("END-ISO-10303-21", tail) == std::string::npos) {
    return bad(file, "truncated STEP file (END-ISO-10303-21 is missing)",
               "Copy or export it again.");
  }
  return {};
}

std::string name_of(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  const TCollection_ExtendedString& wide = name->Get();
  std::string text(static_cast<std::size_t>(wide.LengthOfCString()) + 1, '\0');
  Standard_PCharacter out = text.data();
  text.resize(static_cast<std::size_t>(wide.ToUTF8CString(out)));
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos || text == "NONE") return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::array<double, 3> srgb(const Quantity_Color& color) {
  std::array<double, 3> c{};
  color.Values(c[0], c[1], c[2], Quantity_TOC_sRGB);
  return c;
}

std::array<double, 3> color_of(const XCAFPrs_Style& style) {
  if (!style.IsSetColorSurf()) return {-1, -1, -1};
  return srgb(style.GetColorSurf());
}

std::size_t count(const TopoDS_Shape& shape, TopAbs_ShapeEnum what, TopAbs_ShapeEnum outside) {
  std::size_t n = 0;
  for (TopExp_Explorer it(shape, what, outside); it.More(); it.Next()) ++n;
  return n;
}

struct Found {
  TopoDS_Shape solid;
  SolidInfo info;
};

struct Loose {
  std::size_t shells = 0;
  std::size_t faces = 0;
  std::vector<TopoDS_Shape> all;  // faces outside any solid
};

void collect(const XCAFPrs_DocumentNode& node, std::vector<Found>& found, Loose& loose) {
  const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(node.RefLabel).Located(node.Location);
  if (shape.IsNull()) return;
  loose.shells += count(shape, TopAbs_SHELL, TopAbs_SOLID);
  loose.faces += count(shape, TopAbs_FACE, TopAbs_SHELL);
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next())
    loose.all.push_back(it.Current());
  XCAFPrs_IndexedDataMapOfShapeStyle styles;
  XCAFPrs::CollectStyleSettings(node.RefLabel, node.Location, styles);
  std::string name = name_of(node.RefLabel);
  if (name.empty()) name = name_of(node.Label);
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    Found f{it.Current(), {name, color_of(node.Style), {}, {}}};
    const auto styled = [&](const TopoDS_Shape& s, std::array<double, 3> otherwise) {
      const XCAFPrs_Style* style = styles.Seek(s);
      return style != nullptr && style->IsSetColorSurf() ? color_of(*style) : otherwise;
    };
    f.info.color = styled(shape, f.info.color);
    f.info.color = styled(f.solid, f.info.color);
    for (TopExp_Explorer face(f.solid, TopAbs_FACE); face.More(); face.Next()) {
      f.info.face_colors.push_back(styled(face.Current(), {-1, -1, -1}));
    }
    found.push_back(std::move(f));
  }
}

/// Solids of the same product, or of none, get numbers.
void make_names_unique(std::vector<Found>& found, const std::string& fallback) {
  std::map<std::string, int> uses;
  for (Found& f : found) {
    if (f.info.name.empty()) f.info.name = fallback;
    ++uses[f.info.name];
  }
  std::set<std::string> taken;
  std::map<std::string, int> next;
  for (Found& f : found) {
    const std::string base = f.info.name;
    while (uses[base] > 1 || taken.count(f.info.name) > 0) {
      f.info.name = base + " " + std::to_string(++next[base]);
      if (taken.count(f.info.name) == 0 && uses.count(f.info.name) == 0) break;
    }
    taken.insert(f.info.name);
  }
}

Error no_solid(const std::filesystem::path& file, const std::string& text, const Loose& loose) {
  const std::string hint = "Sew the faces into a solid in the CAD program and export it again.";
  if (loose.shells + loose.faces > 0) {
    std::string what = loose.shells > 0 ? counted(loose.shells, "free shell") : "";
    if (loose.faces > 0) {
      if (!what.empty()) what += " and ";
      what += counted(loose.faces, "loose face");
    }
    return bad(file, "no solid: the file holds only " + what, hint);
  }
  if (text.find("TESSELLATED_") != std::string::npos) {
    return bad(file, "no solid: the file holds tessellated geometry only, and none that is a body",
               "Export the exact (B-rep) geometry, or an STL.");
  }
  return bad(file, "no solid: the file holds no shape", "Export the part again.");
}

/// Bodies without exact geometry come as the triangles that the file holds.
void add_tessellated(const std::string& text, const std::string& fallback, CadContent& content) {
  std::vector<TessellatedBody> bodies = tessellated_bodies(text);
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    CadBody& body = content.bodies.emplace_back();
    body.part.name = bodies[k].name.empty() ? fallback : bodies[k].name;
    if (bodies.size() > 1) body.part.name += " " + std::to_string(k + 1);
    body.part.notes.push_back("No exact geometry: its " + counted(bodies[k].soup.size(), "facet") +
                              " are those of the file.");
    body.rough = merge_exact(bodies[k].soup);
  }
}

/// Sews faces into solids, with a tolerance no wider than needed; what does not close comes as it
/// is.
std::vector<Found> sew(const std::vector<TopoDS_Shape>& faces, const std::string& name,
                       const Progress& progress) {
  Bnd_Box box;
  for (const TopoDS_Shape& face : faces) BRepBndLib::Add(face, box, Standard_False);
  if (box.IsVoid()) return {};
  const double size = std::sqrt(box.SquareExtent());
  TopoDS_Shape sewn;
  double tolerance = 0;
  int open = 0;
  for (const double share : {1e-6, 1e-5, 1e-4, 1e-3}) {
    if (progress.cancelled()) return {};
    tolerance = share * size;
    BRepBuilderAPI_Sewing sewing(tolerance);
    for (const TopoDS_Shape& face : faces) sewing.Add(face);
    sewing.Perform();
    sewn = sewing.SewedShape();
    open = sewing.NbFreeEdges();
    if (open == 0) break;
  }
  if (sewn.IsNull()) return {};
  std::vector<Found> found;
  std::string text =
      counted(faces.size(), "loose face") + " sewn within " + length_text(tolerance) + " mm";
  for (TopExp_Explorer it(sewn, TopAbs_SHELL); it.More(); it.Next()) {
    if (!BRep_Tool::IsClosed(it.Current())) continue;
    BRepBuilderAPI_MakeSolid maker(TopoDS::Shell(it.Current()));
    if (!maker.IsDone()) continue;
    TopoDS_Solid solid = maker.Solid();
    BRepLib::OrientClosedSolid(solid);
    found.push_back({solid, {name, {-1, -1, -1}, {}, {}}});
  }
  if (found.empty()) {
    found.push_back({sewn, {name, {-1, -1, -1}, {}, {}}});
    text += "; " + counted(static_cast<std::size_t>(open), "edge") + " stayed open.";
  } else {
    text += " into " + counted(found.size(), "solid") + ".";
  }
  found[0].info.notes.push_back(text);
  return found;
}

/// The solid after the kernel's own healing; null when that leaves none, or several.
TopoDS_Shape healed(const TopoDS_Shape& solid) {
  ShapeFix_Shape fix(solid);
  fix.Perform();
  const TopoDS_Shape shape = fix.Shape();
  if (shape.IsNull()) return {};
  TopoDS_Shape only;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    if (!only.IsNull()) return {};
    only = it.Current();
  }
  return only;
}

Result<CadBody> body_of(Found found, const LoadParams& params, const Progress& progress) {
  CadBody body;
  body.exact_shape_valid = BRepCheck_Analyzer(found.solid).IsValid();
  const SolidInfo info = found.info;
  Result<Part> part =
      tessellate(found.solid, std::move(found.info), params, body.rough, progress.portion(0, 0.7));
  if (!part && part.error().code != Code::cancelled && params.repair == Repair::automatic) {
    if (const TopoDS_Shape again = healed(found.solid); !again.IsNull()) {
      Triangles rough;
      SolidInfo told = info;
      told.notes.push_back("Healed by the CAD kernel, as before " + part.error().message + ".");
      Result<Part> second =
          tessellate(again, std::move(told), params, rough, progress.portion(0.7, 1));
      if (second || second.error().code == Code::cancelled) part = std::move(second);
    }
  }
  if (part) {
    body.part = *std::move(part);
    body.rough = {};
    return body;
  }
  if (part.error().code == Code::cancelled) return part.error();
  body.refusal = part.error();
  body.part.name = info.name;
  body.part.color = info.color;
  body.part.notes = info.notes;
  return body;
}

/// The shapes of a file with names and colors; false where there is nothing that can be taken over.
template <class Reader>
Result<bool> fill_by(Reader& reader, const std::filesystem::path& file, Document& document,
                     const Error& unreadable, const Progress& progress) {
  reader.SetNameMode(Standard_True);
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) return unreadable;
  if (progress.cancelled()) return cancelled_error();
  Handle(OcctProgress) bridge = new OcctProgress(progress);
  return reader.Transfer(document.get(), bridge->Start());
}

Result<bool> fill_from_step(const std::filesystem::path& file, Document& document,
                            const Progress& progress) {
  STEPCAFControl_Controller::Init();
  STEPCAFControl_Reader reader;
  reader.SetPropsMode(Standard_False);
  reader.SetGDTMode(Standard_False);
  reader.SetMatMode(Standard_False);
  reader.SetViewMode(Standard_False);
  return fill_by(reader, file, document,
                 bad(file, "the STEP text cannot be read", "The file is damaged; export it again."),
                 progress);
}

Result<bool> fill_from_iges(const std::filesystem::path& file, Document& document,
                            const Progress& progress) {
  IGESControl_Controller::Init();
  IGESCAFControl_Reader reader;
  return fill_by(
      reader, file, document,
      bad(file, "not an IGES file, or a damaged one", "Export the part again, best as STEP."),
      progress);
}

Result<bool> fill_from_brep(const std::filesystem::path& file, Document& document,
                            const Progress& progress) {
  TopoDS_Shape shape;
  Handle(OcctProgress) bridge = new OcctProgress(progress);
  if (!BRepTools::Read(shape, file.c_str(), BRep_Builder(), bridge->Start()) || shape.IsNull()) {
    if (progress.cancelled()) return cancelled_error();
    return bad(file, "not a BREP file of OpenCASCADE, or a damaged one", "Write the part again.");
  }
  XCAFDoc_DocumentTool::ShapeTool(document.get()->Main())->AddShape(shape, Standard_False);
  return true;
}

}  // namespace

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::optional<CadFormat> cad_format_of(const std::filesystem::path& file) {
  const std::string ending = extension_of(file);
  if (ending == ".step" || ending == ".stp") return CadFormat::step;
  if (ending == ".iges" || ending == ".igs") return CadFormat::iges;
  if (ending == ".brep" || ending == ".brp") return CadFormat::brep;
  return std::nullopt;
}

Result<void> read_cad(const std::filesystem::path& file, const LoadParams& params,
                      const Progress& progress, CadContent& content) {
  Result<std::string> text = read_file(file);
  if (!text) return text.error();
  if (text->empty()) return bad(file, "the file is empty", "Copy or export it again.");
  const CadFormat format = cad_format_of(file).value_or(CadFormat::step);
  if (format == CadFormat::step)
    if (Result<void> envelope = check_envelope(file, *text); !envelope) return envelope.error();
  if (progress.cancelled()) return cancelled_error();

  const Setting unit("xstep.cascade.unit", "MM");
  Document document;
  const Progress reading = progress.portion(0.05, 0.4, "Reading the CAD file");
  const Result<bool> filled = format == CadFormat::step   ? fill_from_step(file, document, reading)
                              : format == CadFormat::iges ? fill_from_iges(file, document, reading)
                                                          : fill_from_brep(file, document, reading);
  if (!filled) return filled.error();
  const bool transferred = *filled;
  if (progress.cancelled()) return cancelled_error();

  std::vector<Found> found;
  Loose loose;
  if (transferred) {
    for (XCAFPrs_DocumentExplorer it(document.get(), XCAFPrs_DocumentExplorerFlags_OnlyLeafNodes);
         it.More(); it.Next()) {
      collect(it.Current(), found, loose);
    }
  }
  const bool had_solids = !found.empty();
  content.free_shells = loose.shells;
  content.free_faces = loose.faces;
  if (found.empty() && params.repair != Repair::none)
    found = sew(loose.all, file.stem().string(), progress);
  if (progress.cancelled()) return cancelled_error();
  if (found.empty() && loose.all.empty() && format == CadFormat::step) {
    add_tessellated(*text, file.stem().string(), content);
    if (!content.bodies.empty()) return {};
  }
  if (found.empty()) return no_solid(file, *text, loose);
  make_names_unique(found, file.stem().string());
  if (had_solids && loose.shells + loose.faces > 0) {
    found[0].info.notes.push_back(counted(loose.shells, "free shell") + " and " +
                                  counted(loose.faces, "loose face") +
                                  " beside the solids of the file were left out.");
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const auto at = [&](std::size_t i) {
      return 0.4 + 0.6 * static_cast<double>(i) / static_cast<double>(found.size());
    };
    if (progress.cancelled()) return cancelled_error();
    Result<CadBody> body =
        body_of(std::move(found[k]), params, progress.portion(at(k), at(k + 1), "Tessellating"));
    if (!body) return body.error();
    content.bodies.push_back(*std::move(body));
  }
  return {};
}

}  // namespace lamella
