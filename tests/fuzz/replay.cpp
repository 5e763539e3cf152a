// Runs a fuzz target over the files of its committed corpus, in builds without a fuzzer. Arguments: the
// folder.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz_checks.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: NAME_fuzz FOLDER\n", stderr);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) files.push_back(entry.path());
  if (files.empty()) {
    std::fprintf(stderr, "%s is empty: it should hold the corpus\n", argv[1]);
    return 1;
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    // As many bytes as the file has, so that a sanitizer sees who reads beyond them.
    const std::vector<char> input{std::istreambuf_iterator<char>(stream), {}};
    std::fprintf(stderr, "%s, %zu bytes\n", file.c_str(), input.size());
    mssim::LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  }
  std::printf("%zu inputs\n", files.size());
  return 0;
}
