#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// A body with its elements and volume (mm^3), or a group with its facets and area (mm^2).
struct NamedMeasure {
  std::string name;
  std::size_t count = 0;
  double measure = 0;
};

/// What an export must carry over, counted.
struct MeshSummary {
  std::size_t nodes = 0;
  std::vector<NamedMeasure> bodies;
  std::vector<NamedMeasure> groups;
};

MeshSummary summarize(const SimplexMesh<3>& mesh);

/// Proof that a file holds what was to be written: it was read again and compared.
struct ExportCertificate {
  std::string file;    ///< name without folder
  std::string format;  ///< as "Gmsh MSH 4.1"
  bool agrees = false;
  double worst_difference = 0;  ///< largest relative difference of an area or a volume
  std::string finding;          ///< what differs; empty when it agrees
  MeshSummary read_back;
  std::vector<std::string> notes{};  ///< what the user should know before a solver reads the file
};

/// Compares counts, names, areas and volumes, these to 1e-9 relative. `names` false leaves the
/// names out, and with them bodies and groups without entries, for formats that have no place for
/// them.
ExportCertificate certify(const std::string& file, const std::string& format,
                          const MeshSummary& written, const MeshSummary& read_back,
                          bool names = true, double tolerance = 1e-9);

}  // namespace lamella
