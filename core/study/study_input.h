#pragma once

#include <cstdint>
#include <string>

namespace lamella {

/// A file of a study, such as a STEP or STL part, and what it held when it was read.
struct StudyInput {
  std::string file;       ///< relative to the study's folder, or absolute
  double unit = 1;        ///< mm per unit of a file that names none, as STL
  std::string sha256{};   ///< of its content; empty: not known
  std::uint64_t bytes{};  ///< its size, where the hash is known
  std::string entry{};    ///< of the copy within the project file; empty: none

  bool operator==(const StudyInput&) const = default;
};

}  // namespace lamella
