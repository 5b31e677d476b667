// Runs a fuzz target without libFuzzer: every file as it is, then as many damaged copies as asked.
//
//   TARGET [-rounds=N] [-seed=S] FILE_OR_FOLDER...

#include <cstring>
#include <iterator>

#include "tests/fuzz/target.h"
#include "tests/support/damage.h"

int main(int count, char** arguments) {
  namespace fs = std::filesystem;
  long rounds = 0;
  unsigned long seed = 1;
  std::vector<fs::path> files;
  for (int i = 1; i < count; ++i) {
    if (std::strncmp(arguments[i], "-rounds=", 8) == 0) {
      rounds = std::atol(arguments[i] + 8);
    } else if (std::strncmp(arguments[i], "-seed=", 6) == 0) {
      seed = std::strtoul(arguments[i] + 6, nullptr, 10);
    } else if (fs::is_directory(arguments[i])) {
      for (const auto& entry : fs::recursive_directory_iterator(arguments[i]))
        if (entry.is_regular_file()) files.push_back(entry.path());
    } else {
      files.emplace_back(arguments[i]);
    }
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const fs::path& file : files) {
    const auto bytes = lamella::read_file(file);
    if (!bytes) {
      std::fprintf(stderr, "%s: %s\n", file.c_str(), bytes.error().message.c_str());
      return 2;
    }
    seeds.push_back(*bytes);
  }
  if (seeds.empty()) {
    std::fprintf(stderr, "usage: TARGET [-rounds=N] [-seed=S] FILE_OR_FOLDER...\n");
    return 2;
  }
  const auto run = [](const std::string& bytes) {
    // A copy of just this size: a read beyond the end is seen.
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    LLVMFuzzerTestOneInput(copy.data(), copy.size());
  };
  for (const std::string& bytes : seeds) run(bytes);
  const std::size_t whole = lamella::test::accepted;
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  for (long k = 0; k < rounds; ++k) {
    run(lamella::test::damaged(seeds[random() % seeds.size()], random));
    if (k % 1000 == 999) std::fprintf(stderr, "%ld\n", k + 1);
  }
  std::printf("%zu of %zu files accepted; of %ld damaged ones %zu, the others refused\n", whole,
              seeds.size(), rounds, lamella::test::accepted - whole);
  return 0;
}
