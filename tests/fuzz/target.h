#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "core/base/atomic_file.h"
#include "tests/support/temporary_folder.h"

/// What libFuzzer, or driver.cpp, calls for each input: reads it, and ends the program by abort()
/// where what was read is not sound.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace lamella::test {

/// Inputs that were read and found sound; the others were refused.
inline std::size_t accepted = 0;

/// A folder of this process, removed at its end.
inline const TemporaryFolder& fuzz_folder() {
  static const TemporaryFolder folder;
  return folder;
}

/// The input as a file of this name.
inline std::filesystem::path input_file(const std::uint8_t* data, std::size_t size,
                                        const std::string& name) {
  const std::filesystem::path file = fuzz_folder() / name;
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (out == nullptr || (size > 0 && std::fwrite(data, 1, size, out) != size)) std::abort();
  std::fclose(out);
  return file;
}

inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s\n", what);
  std::abort();
}

/// Of a reader's answer: an error says something; whether there is a value to judge.
template <class T>
bool answered(const Result<T>& result) {
  if (result.ok()) {
    ++accepted;
    return true;
  }
  require(!result.error().message.empty(), "an error has a message");
  return false;
}

}  // namespace lamella::test
