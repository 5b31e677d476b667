#pragma once

#include <string>
#include <vector>

#include "core/metric/metric.h"

namespace lamella {

/// A number for each element, by name.
struct ElementField {
  std::string name;
  std::vector<double> values;  ///< [element]
};

/// Numbers or vectors at the nodes, by name.
struct NodeField {
  std::string name;
  int components = 1;          ///< 1 or 3
  std::vector<double> values;  ///< [node * components + component], the virtual node too
};

/// Fields to be written beside a mesh of tetrahedra; a null pointer is left out. Borrowed, never
/// owned. Node fields are indexed by NodeId, entry 0 is the virtual node.
struct MeshFields {
  const MetricField<3>* metric = nullptr;          ///< [node] mm^-2
  const std::vector<double>* thickness = nullptr;  ///< [node] mm
  const std::vector<double>* layers = nullptr;     ///< [node] measured; NaN where not
  const std::vector<double>* quality = nullptr;    ///< [element] c(T), eq. (3.7)
  std::vector<ElementField> of_elements{};         ///< further ones; VTU only
  std::vector<NodeField> of_nodes{};               ///< the same at the nodes
};

}  // namespace lamella
