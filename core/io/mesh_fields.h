#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/mesh/simplex_mesh.h"
#include "core/metric/metric.h"

namespace lamella {

/// A number for each element, by name.
struct ElementField {
  std::string name;
  std::vector<double> values;  ///< [element]
};

/// The field of a body's filling ratios is called "filling BODY".
inline constexpr std::string_view kFillingField = "filling ";

/// Unit of the coordinates in a file; within the program it is always mm.
enum class LengthUnit { mm, m };
/// "mm" or "m".
inline const char* unit_name(LengthUnit unit) { return unit == LengthUnit::m ? "m" : "mm"; }

/// Numbers or vectors at the nodes, by name.
struct NodeField {
  std::string name;
  int components = 1;          ///< 1 or 3
  std::vector<double> values;  ///< [node * components + component], the virtual node too
};

/// Symmetric matrices of a file that are not called its metric, as other programs write them.
struct TensorField {
  std::string name;
  bool of_nodes = true;
  std::vector<Metric<3>> values;  ///< [node], the virtual one too, or [element]
};

/// Fields to be written beside a mesh of tetrahedra; a null pointer is left out. Borrowed, never
/// owned. Node fields are indexed by NodeId, entry 0 is the virtual node.
struct MeshFields {
  const MetricField<3>* metric = nullptr;          ///< [node] mm^-2
  const std::vector<double>* thickness = nullptr;  ///< [node] mm
  const std::vector<double>* layers = nullptr;     ///< [node] measured; NaN where not
  const std::vector<double>* quality = nullptr;    ///< [element] c(T), eq. (3.7)
  std::vector<ElementField> of_elements{};         ///< further ones, the filling ratios among them
  std::vector<NodeField> of_nodes{};               ///< the same at the nodes; VTU and MSH
  LengthUnit unit = LengthUnit::mm;  ///< of all the above and of the mesh, for those that tell it
  std::string provenance{};          ///< JSON object: program, study, inputs; VTU only
};

/// What a mesh file holds; fields that it has not are empty.
struct MeshContent {
  SimplexMesh<3> mesh;
  MetricField<3> metric;                  ///< [node]
  std::vector<double> thickness;          ///< [node]
  std::vector<double> layers;             ///< [node]
  std::vector<double> quality;            ///< [element]
  std::vector<ElementField> of_elements;  ///< further numbers of elements
  std::vector<NodeField> of_nodes;        ///< further numbers and vectors at the nodes
  std::vector<TensorField> tensors;       ///< of VTU and MSH
  LengthUnit unit = LengthUnit::mm;       ///< of all the above, where the file tells it
  std::string provenance;                 ///< JSON object, as it was written
};

}  // namespace lamella
