#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/progress.h"
#include "core/base/result.h"
#include "core/io/mesh_fields.h"
#include "core/mesh/simplex_mesh.h"

namespace lamella {

/// Which names a format can hold. Letters and digits always; letters outside of ASCII and all other
/// marks only with `any`, which excludes double quotes and control characters alone.
struct NameRule {
  bool exact = false;  ///< all names just as they are
  bool any = true;
  std::string_view never = {};   ///< not even with `any`
  std::string_view marks = "_";  ///< allowed beside letters and digits where not `any`
  std::size_t longest = 0;       ///< bytes; 0: no bound
  bool shared = false;      ///< bodies and groups share one list of names, in which case is ignored
  bool references = false;  ///< numbers alone: names "ref r" stay, others become "ref 1", ..
};

/// The number r of a name "ref r".
std::optional<std::int64_t> reference_of(const std::string& name);

/// Names as the format can hold them, all different: what is not allowed becomes "_", and a number
/// behind a name tells equal ones apart. `taken` holds names that others have, and grows.
std::vector<std::string> names_in_file(const std::vector<std::string>& names, const NameRule& rule,
                                       std::vector<std::string>& taken);

/// A mesh format: what it can carry, who writes it and who reads it back.
struct MeshFormat {
  /// Remarks for the user, such as a warning of what a solver will complain about.
  using Notes = std::vector<std::string>;

  std::string name;                  ///< as --format takes it: "abaqus"
  std::string title;                 ///< for people: "Abaqus, CalculiX"
  std::vector<std::string> endings;  ///< with their dot, lower case; the first is the usual one

  // What the file itself holds; the rest goes into files beside it (core/io/mesh_file.h).
  bool bodies = true;
  bool groups = true;
  bool filling = false;     ///< numbers of elements
  bool metric = false;      ///< of nodes
  bool provenance = false;  ///< where the mesh comes from

  NameRule names{};
  bool meters = false;         ///< the format knows no other unit
  bool compact = false;        ///< nodes that no element uses must not be there
  bool boundary_only = false;  ///< STL: triangles, which cannot be read as a mesh

  std::function<Result<Notes>(const SimplexMesh<3>&, const MeshFields&,
                              const std::filesystem::path&, const Progress&)>
      write;
  std::function<Result<MeshContent>(const std::filesystem::path&, const Progress&)> read;
};

/// How a file is to be written.
struct ExportOptions {
  std::string format{};  ///< by its name; empty: by the ending of the file
  LengthUnit unit = LengthUnit::mm;
};

/// The formats that need no library: msh, msh22, medit, openfoam, abaqus, unv, nastran, cimlib,
/// stl.
std::vector<MeshFormat> own_formats();

/// All formats of a program, in the order in which they are offered.
class MeshFormats {
 public:
  void add(std::vector<MeshFormat> formats);
  /// Says why files with this ending cannot be used, where a library was missing.
  void add_missing(const std::string& name, const std::string& ending, const std::string& why);

  const std::vector<MeshFormat>& all() const { return formats_; }
  /// Errors: usage, naming the formats (or what is missing).
  Result<const MeshFormat*> called(const std::string& name) const;
  /// By the ending, in upper or lower case. Errors: usage, naming the endings.
  Result<const MeshFormat*> of_file(const std::filesystem::path& file) const;

 private:
  struct Missing {
    std::string name, ending, why;
  };
  std::vector<MeshFormat> formats_;
  std::vector<Missing> missing_;
};

}  // namespace lamella
