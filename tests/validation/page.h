#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/result.h"

namespace lamella {

/// Replaces what stands between the comments "table NAME" and "end" of a page.
inline Result<void> set_table(std::string& page, const std::string& name,
                              const std::string& table) {
  const std::string begin = "<!-- table " + name + " -->\n", end = "<!-- end -->";
  const std::size_t from = page.find(begin);
  const std::size_t to = from == std::string::npos ? from : page.find(end, from);
  if (to == std::string::npos)
    return Error{Code::bad_input, "The page has no place for the table \"" + name + "\".",
                 "It stands between the lines <!-- table " + name + " --> and " + end + "."};
  page.replace(from + begin.size(), to - from - begin.size(), table);
  return {};
}

/// The main function of a program that writes tables into validation.md: its folder, and that of
/// the real parts or what `second` says, which may be left out.
template <class Regenerate>
int write_tables(int argc, char** argv, const char* program, Regenerate&& regenerate,
                 const char* second =
                     "[PARTS], the folder that holds validation.md and that of "
                     "the CAD files") {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: %s FOLDER %s\n", program, second);
    return exit_code(Code::usage);
  }
  std::optional<std::filesystem::path> more;
  if (argc == 3) more = argv[2];
  const Result<void> done = regenerate(argv[1], more);
  if (done) return 0;
  std::fprintf(stderr, "%s %s\n", done.error().message.c_str(), done.error().hint.c_str());
  return exit_code(done.error().code);
}

}  // namespace lamella
