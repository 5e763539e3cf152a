#include "platform/find_program.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace mssim {

namespace fs = std::filesystem;

namespace {

bool may_be_executed(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0;
}

/// Of a script: #! and the rest of its line. Empty for what is none.
std::string first_line(const fs::path& file) {
  std::array<char, 256> bytes{};  // no system reads more of it
  std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size() - 1);
  std::string line(bytes.data());
  line.resize(std::min(line.find('\n'), line.size()));
  return line.starts_with("#!") ? line : "";
}

}  // namespace

std::optional<fs::path> find_program(const std::string& name) {
  if (name.find('/') != std::string::npos)
    return may_be_executed(name) ? std::optional(fs::absolute(name)) : std::nullopt;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path candidate = fs::path(folder.empty() ? "." : folder) / name;
    if (may_be_executed(candidate)) return fs::absolute(candidate);
  }
  return std::nullopt;
}

bool names_interpreter_with_return(const fs::path& file) { return first_line(file).ends_with('\r'); }

std::string why_not_executed(const fs::path& file, int error) {
  const std::string reason = " (" + std::string(std::strerror(error)) + ")";
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) return "it is a folder";
  if (names_interpreter_with_return(file))
    return "its lines end as Windows has it (CR LF), also the name of its interpreter; save it with lines "
           "that end in LF (sed -i 's/\\r$//')";
  if (error == ENOENT && !fs::exists(file, ignored)) return "there is no such file";
  if (error == EACCES && ::access(file.c_str(), X_OK) != 0) return "it is not executable (chmod +x)";
  if (error == ENOEXEC)
    return "it is neither a program for this machine nor a script whose first line names an interpreter "
           "(#!/usr/bin/env python3)";
  std::string line = first_line(file);
  if (line.empty()) return "the system does not start it" + reason;
  line = line.substr(std::min(line.find_first_not_of(" \t", 2), line.size()), 200);
  return "its interpreter " + line.substr(0, line.find_first_of(" \t")) + " cannot be started" + reason;
}

}  // namespace mssim
