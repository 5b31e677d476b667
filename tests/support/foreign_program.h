#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella::test {

/// What a command prints, to both outputs, when run in a folder. The exit status is left aside:
/// validators return 0 for meshes they find fault with.
inline std::string output_of(const std::filesystem::path& folder, const std::string& command) {
  FILE* pipe = ::popen(("cd '" + folder.string() + "' && { " + command + "; } 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  ::pclose(pipe);
  return text;
}

inline bool is_installed(const std::string& program) {
  return !output_of(".", "command -v " + program).empty();
}

/// An OpenFOAM program, which must be told where its settings are.
inline std::string open_foam(const std::string& command) {
  const char* const folder = "/usr/share/openfoam";  // of the Debian package
  if (std::getenv("WM_PROJECT_DIR") || !std::filesystem::exists(folder)) return command;
  return std::string("WM_PROJECT_DIR=") + folder + " " + command;
}

/// How often a text has a word.
inline int count_of(const std::string& text, const std::string& word) {
  int n = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

/// The number behind the first `label` of a text; NaN when there is none.
inline double number_behind(const std::string& text, const std::string& label) {
  const std::size_t at = text.find(label);
  if (at == std::string::npos) return std::nan("");
  return std::strtod(text.c_str() + at + label.size(), nullptr);
}

/// The numbers behind a label up to a closing mark, as "x = 1, 2 ;"; none without the label.
inline std::vector<double> numbers_behind(const std::string& text, const std::string& label,
                                          char close) {
  std::vector<double> numbers;
  std::size_t at = text.find(label);
  if (at == std::string::npos) return numbers;
  at += label.size();
  const char* next = text.c_str() + at;
  const char* const end = text.c_str() + std::min(text.size(), text.find(close, at));
  while (next < end) {
    char* after = nullptr;
    const double number = std::strtod(next, &after);
    if (after > next && after <= end) numbers.push_back(number);
    next = after > next ? after : next + 1;
  }
  return numbers;
}

}  // namespace lamella::test

/// Someone else's reader need not be installed: our own round trips always run.
#define LAMELLA_NEEDS_PROGRAM(program)       \
  if (!lamella::test::is_installed(program)) \
  GTEST_SKIP() << program << " is not installed: its reading of the file is not tried"
