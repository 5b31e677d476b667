#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ui/services.h"

namespace lamella::ui {

/// Where a part came from, so that it can be read again with another tolerance.
struct PartSource {
  std::filesystem::path file;
  std::size_t index = 0;  ///< among the bodies of its file
  double unit = 1;        ///< mm per unit of the file
};

struct ReadParts {
  std::vector<Part> parts;
  std::vector<PartSource> sources;  ///< one a part
};

/// Whether it is an STL by its ending: those have no unit.
bool names_stl(const std::filesystem::path& file);

/// The bodies of the files, in order, under the names that their files give them. `units`: one a
/// file, mm; 0, of a file without unit, becomes the likely one of its size. Errors: those of
/// Services::load_parts.
Result<ReadParts> read_parts(const Services& services,
                             const std::vector<std::filesystem::path>& files,
                             std::vector<double>& units, const LoadParams& params,
                             const Progress& progress);

/// Gives the parts from number `first` on names that neither the parts before nor `left_out` have,
/// as `study_parts` does, and takes those out that are left out.
void name_parts(ReadParts& read, std::size_t first, const std::vector<std::string>& left_out,
                bool drop_left_out);

/// The parts again, with surfaces of other tolerances. Errors: those of Services::load_parts;
/// bad_input when a file has changed.
Result<std::vector<Part>> read_again(const Services& services, const std::vector<Part>& parts,
                                     const std::vector<PartSource>& sources,
                                     const LoadParams& params, const Progress& progress);

}  // namespace lamella::ui
