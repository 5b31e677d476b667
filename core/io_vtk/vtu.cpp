#include "core/io_vtk/vtu.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataSetTriangleFilter.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "core/base/atomic_file.h"
#include "core/io/mesh_file.h"
#include "core/io/read_in_child.h"
#include "core/io/vtu.h"

namespace lamella {

namespace {

/// VTK prints its complaints; we return ours. Silent while it lives.
class Quiet {
 public:
  Quiet() : before_(vtkObject::GetGlobalWarningDisplay()) { vtkObject::GlobalWarningDisplayOff(); }
  ~Quiet() { vtkObject::SetGlobalWarningDisplay(before_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  int before_;
};

std::vector<std::string> strings_of(vtkFieldData* data, const char* name) {
  std::vector<std::string> values;
  if (auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(name)))
    for (vtkIdType i = 0; i < array->GetNumberOfValues(); ++i) values.push_back(array->GetValue(i));
  return values;
}

std::vector<double> node_scalar_of(vtkUnstructuredGrid* grid, const char* name) {
  vtkDataArray* array = grid->GetPointData()->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 1) return {};
  std::vector<double> values(static_cast<std::size_t>(grid->GetNumberOfPoints()) + 1, 0);
  for (vtkIdType v = 0; v < grid->GetNumberOfPoints(); ++v)
    values[static_cast<std::size_t>(v) + 1] = array->GetComponent(v, 0);
  return values;
}

/// The point arrays of one or three components that have no place of their own.
std::vector<NodeField> node_fields_of(vtkUnstructuredGrid* grid) {
  std::vector<NodeField> out;
  for (int a = 0; a < grid->GetPointData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid->GetPointData()->GetArray(a);
    if (!array || !array->GetName()) continue;
    const std::string name = array->GetName();
    const int components = array->GetNumberOfComponents();
    if ((components != 1 && components != 3) || name == "thickness" || name == "layers") continue;
    NodeField field{name, components, std::vector<double>(static_cast<std::size_t>(components))};
    for (vtkIdType v = 0; v < array->GetNumberOfTuples(); ++v)
      for (int c = 0; c < components; ++c) field.values.push_back(array->GetComponent(v, c));
    out.push_back(std::move(field));
  }
  return out;
}

/// The matrix in a tuple of six components, as VTK orders them, or of all nine.
Metric<3> matrix_of(vtkDataArray* array, vtkIdType at) {
  Metric<3> m;
  if (array->GetNumberOfComponents() == 9) {
    for (int c = 0; c < 9; ++c) m(c / 3, c % 3) = array->GetComponent(at, c);
    return (m + m.transpose()) / 2;
  }
  for (int c = 0; c < 6; ++c) {
    const auto [i, j] = kVtkTensor[c];
    m(i, j) = m(j, i) = array->GetComponent(at, c);
  }
  return m;
}

bool is_tensor(vtkDataArray* array) {
  return array && array->GetName() &&
         (array->GetNumberOfComponents() == 6 || array->GetNumberOfComponents() == 9);
}

/// Value of a cell array of ids; 0 where there is none. `names` grows to hold every id.
std::int32_t id_of(vtkDataArray* array, vtkIdType cell, std::vector<std::string>* names) {
  const auto id =
      array ? static_cast<std::int32_t>(std::max(0.0, array->GetComponent(cell, 0))) : 0;
  while (names && names->size() <= static_cast<std::size_t>(id) && names->size() < 100000)
    names->push_back("number " + std::to_string(names->size()));
  return id;
}

/// Those of second order count by their corners.
bool is_tetrahedron(int type) { return type == VTK_TETRA || type == VTK_QUADRATIC_TETRA; }

void take(vtkUnstructuredGrid* grid, MeshContent& out) {
  SimplexMesh<3>& mesh = out.mesh;
  for (vtkIdType v = 0; v < grid->GetNumberOfPoints(); ++v) {
    Vec<3> x;
    grid->GetPoint(v, x.data());
    mesh.points.push_back(x);
  }
  mesh.bodies = strings_of(grid->GetFieldData(), "body_names");
  mesh.groups = strings_of(grid->GetFieldData(), "group_names");
  const std::vector<std::string> unit = strings_of(grid->GetFieldData(), "unit");
  if (!unit.empty() && unit[0] == "m") out.unit = LengthUnit::m;
  if (const auto texts = strings_of(grid->GetFieldData(), "provenance"); !texts.empty())
    out.provenance = texts[0];
  vtkDataArray* body = grid->GetCellData()->GetArray("body");
  vtkDataArray* group = grid->GetCellData()->GetArray("group");
  vtkDataArray* face = grid->GetCellData()->GetArray("face");
  vtkDataArray* quality = grid->GetCellData()->GetArray("quality");
  std::vector<vtkDataArray*> further;
  for (int a = 0; a < grid->GetCellData()->GetNumberOfArrays(); ++a) {
    auto* array = vtkDoubleArray::SafeDownCast(grid->GetCellData()->GetAbstractArray(a));
    if (!array || array->GetNumberOfComponents() != 1 || array == quality || !array->GetName())
      continue;
    further.push_back(array);
    out.of_elements.push_back({array->GetName(), {}});
  }
  vtkNew<vtkIdList> nodes;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    const int type = grid->GetCellType(c);
    const bool solid = is_tetrahedron(type);
    if (!solid && type != VTK_TRIANGLE && type != VTK_QUADRATIC_TRIANGLE) continue;
    grid->GetCellPoints(c, nodes);
    std::array<NodeId, 4> v{};
    for (vtkIdType k = 0; k < (solid ? 4 : 3); ++k) v[k] = static_cast<NodeId>(nodes->GetId(k)) + 1;
    if (solid) {
      mesh.elements.push_back(v);
      mesh.element_body.push_back(id_of(body, c, &mesh.bodies));
      if (quality) out.quality.push_back(quality->GetComponent(c, 0));
      for (std::size_t f = 0; f < further.size(); ++f)
        out.of_elements[f].values.push_back(further[f]->GetComponent(c, 0));
    } else {
      mesh.facets.push_back({v[0], v[1], v[2]});
      mesh.facet_group.push_back(id_of(group, c, &mesh.groups));
      mesh.facet_face.push_back(id_of(face, c, nullptr));
    }
  }
  out.thickness = node_scalar_of(grid, "thickness");
  out.layers = node_scalar_of(grid, "layers");
  out.of_nodes = node_fields_of(grid);
  for (int a = 0; a < grid->GetPointData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid->GetPointData()->GetArray(a);
    if (!is_tensor(array)) continue;
    std::vector<Metric<3>> values(mesh.points.size(), Metric<3>::Identity());
    for (vtkIdType v = 0; v < grid->GetNumberOfPoints(); ++v)
      values[static_cast<std::size_t>(v) + 1] = matrix_of(array, v);
    if (std::string_view(array->GetName()) == "metric")
      out.metric = std::move(values);
    else
      out.tensors.push_back({array->GetName(), true, std::move(values)});
  }
  for (int a = 0; a < grid->GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid->GetCellData()->GetArray(a);
    if (!is_tensor(array)) continue;
    TensorField field{array->GetName(), false, {}};
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
      if (is_tetrahedron(grid->GetCellType(c))) field.values.push_back(matrix_of(array, c));
    out.tensors.push_back(std::move(field));
  }
}

/// What a cell is called that is a solid and no tetrahedron; null for all others.
const char* solid_called(int type) {
  switch (type) {
    case VTK_VOXEL:
    case VTK_HEXAHEDRON:
    case VTK_QUADRATIC_HEXAHEDRON:
    case VTK_TRIQUADRATIC_HEXAHEDRON:
      return "hexahedra";
    case VTK_WEDGE:
    case VTK_QUADRATIC_WEDGE:
      return "prisms";
    case VTK_PYRAMID:
    case VTK_QUADRATIC_PYRAMID:
      return "pyramids";
    case VTK_POLYHEDRON:
      return "polyhedra";
    default:
      return nullptr;
  }
}

/// False when a cell refers to a point that is not there, or an array has a wrong length.
bool consistent(vtkUnstructuredGrid* grid) {
  if (!grid->GetCells()) return grid->GetNumberOfCells() == 0;
  vtkDataArray* ids = grid->GetCells()->GetConnectivityArray();
  for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i) {
    const double id = ids->GetComponent(i, 0);
    if (id < 0 || id >= static_cast<double>(grid->GetNumberOfPoints())) return false;
  }
  const auto lengths = [](vtkFieldData* data, vtkIdType n) {
    for (int a = 0; a < data->GetNumberOfArrays(); ++a)
      if (data->GetAbstractArray(a)->GetNumberOfTuples() != n) return false;
    return true;
  };
  return lengths(grid->GetPointData(), grid->GetNumberOfPoints()) &&
         lengths(grid->GetCellData(), grid->GetNumberOfCells());
}

Result<vtkSmartPointer<vtkUnstructuredGrid>> read_grid(const std::filesystem::path& file) {
  // VTK's parser takes anything it is given; what is no VTU file at all is better told before.
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::error_code ec;
  if (!stream || !std::filesystem::is_regular_file(file, ec))
    if (const Result<std::string> whole = read_file(file); !whole) return whole.error();
  const std::streamoff size = stream.tellg();
  const auto piece = [&](std::streamoff at) {
    std::string bytes(static_cast<std::size_t>(std::min<std::streamoff>(size - at, 4096)), '\0');
    stream.seekg(at).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return bytes;
  };
  const std::string head = piece(0), tail = piece(std::max<std::streamoff>(0, size - 4096));
  const auto refuse = [&](const std::string& finding, const std::string& hint) {
    return Error{Code::bad_input, "\"" + file.string() + "\": " + finding + ".", hint};
  };
  if (head.find("<VTKFile") == head.npos || head.find("UnstructuredGrid") == head.npos)
    return refuse("not a VTU file", "Give a VTK XML unstructured grid.");
  if (tail.rfind("</VTKFile>") == std::string::npos)
    return refuse("the file ends too early", "It may be truncated; write or copy it again.");

  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  const vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !grid || !consistent(grid))
    return refuse("the file is damaged", "Write or copy it again.");
  return grid;
}

Error no_tetrahedra(const std::filesystem::path& file) {
  return {Code::bad_input, "\"" + file.string() + "\": it holds no tetrahedra.",
          "Only volume meshes of tetrahedra can be used."};
}

bool is_second_order(vtkUnstructuredGrid* grid) {
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
    if (grid->GetCellType(c) == VTK_QUADRATIC_TETRA) return true;
  return false;
}

/// Arrays of the cells of a grid of tetrahedra at its points, behind those in `fields`.
void add_cell_fields(vtkUnstructuredGrid* grid, const SimplexMesh<3>& mesh,
                     std::vector<NodeField>& fields) {
  std::vector<double> volume(mesh.elements.size()), around(mesh.points.size(), 0);
  for (std::size_t e = 0; e < volume.size(); ++e) {
    volume[e] = std::abs(signed_measure<3>(mesh.corners(mesh.elements[e])));
    for (const NodeId n : mesh.elements[e]) around[n] += volume[e];
  }
  for (int a = 0; a < grid->GetCellData()->GetNumberOfArrays(); ++a) {
    vtkDataArray* array = grid->GetCellData()->GetArray(a);
    if (!array || !array->GetName()) continue;
    const int components = array->GetNumberOfComponents();
    NodeField field{array->GetName(), components, {}};
    const auto known = [&](const NodeField& f) { return f.name == field.name; };
    if ((components != 1 && components != 3) || std::any_of(fields.begin(), fields.end(), known))
      continue;
    field.values.assign(mesh.points.size() * static_cast<std::size_t>(components), 0);
    std::size_t e = 0;
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
      if (grid->GetCellType(c) != VTK_TETRA) continue;
      for (const NodeId n : mesh.elements[e])
        for (int k = 0; k < components; ++k)
          if (around[n] > 0)
            field.values[n * static_cast<std::size_t>(components) + static_cast<std::size_t>(k)] +=
                volume[e] / around[n] * array->GetComponent(c, k);
      ++e;
    }
    fields.push_back(std::move(field));
  }
}

bool has_ending(const std::filesystem::path& file, std::initializer_list<std::string_view> known) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(known.begin(), known.end(), ending) != known.end();
}

Result<vtkSmartPointer<vtkUnstructuredGrid>> read_legacy(const std::filesystem::path& file) {
  if (Result<std::string> whole = read_file(file); !whole) return whole.error();
  vtkNew<vtkUnstructuredGridReader> reader;
  reader->SetFileName(file.c_str());
  if (!reader->IsFileUnstructuredGrid())
    return Error{Code::bad_input,
                 "\"" + file.string() + "\": it holds no unstructured grid of VTK.",
                 "Save the result as an unstructured grid (.vtu)."};
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  const vtkSmartPointer<vtkUnstructuredGrid> grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !grid || !consistent(grid))
    return Error{Code::bad_input, "\"" + file.string() + "\": the file is damaged.",
                 "Write or copy it again."};
  return grid;
}

Result<MeshContent> solver_result(const std::filesystem::path& file, const Progress&) {
  const Quiet quiet;
  const auto grid = has_ending(file, {".vtk"}) ? read_legacy(file) : read_grid(file);
  if (!grid) return grid.error();
  vtkSmartPointer<vtkUnstructuredGrid> cut = *grid;
  for (vtkIdType c = 0; c < cut->GetNumberOfCells(); ++c) {
    const int type = cut->GetCellType(c);
    if (type == VTK_TETRA || type == VTK_TRIANGLE) continue;
    vtkNew<vtkDataSetTriangleFilter> cutter;
    cutter->SetInputData(cut);
    cutter->TetrahedraOnlyOn();
    cutter->Update();
    cut = cutter->GetOutput();
    break;
  }
  MeshContent all;
  take(cut, all);
  if (all.mesh.elements.empty()) return no_tetrahedra(file);
  MeshContent out;
  out.mesh = std::move(all.mesh);
  out.of_nodes = node_fields_of(cut);
  add_cell_fields(cut, out.mesh, out.of_nodes);
  return out;
}

}  // namespace

Result<MeshContent> read_vtu(const std::filesystem::path& file) {
  const Quiet quiet;
  const auto grid = read_grid(file);
  if (!grid) return grid.error();
  for (vtkIdType c = 0; c < (*grid)->GetNumberOfCells(); ++c)
    if (const char* solid = solid_called((*grid)->GetCellType(c)))
      return Error{Code::bad_input, "\"" + file.string() + "\": it holds " + solid + ".",
                   "Only tetrahedra of first and second order can be used."};
  MeshContent content;
  take(*grid, content);
  if (is_second_order(*grid)) drop_unused_nodes(content);
  if (content.mesh.elements.empty()) return no_tetrahedra(file);
  return content;
}

Result<MeshContent> read_vtk_result(const std::filesystem::path& file, const Progress& progress) {
  if (has_ending(file, {".vtp"}))
    return Error{Code::bad_input, "\"" + file.string() + "\" is the result on a surface alone.",
                 "Give the .vtu of the volume, of OpenFOAM internal.vtu."};
  if (has_ending(file, {".pvtu", ".pvd", ".vtm", ".vtmb", ".series"}))
    return Error{Code::bad_input, "\"" + file.string() + "\" is a list of files, no result itself.",
                 "Give the .vtu of the volume that it names (of OpenFOAM internal.vtu), or save it "
                 "as one .vtu: in ParaView by Merge Blocks and Save Data."};
  return read_in_child(file, solver_result, progress);
}

}  // namespace lamella
