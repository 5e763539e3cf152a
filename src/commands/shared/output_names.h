#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

/// A file of a command: what it is, as messages call it, and where.
struct NamedFile {
  std::string role;  ///< for example "--trace"
  std::filesystem::path path;
};

/// Throws UsageError unless every file that a command writes, also under the name that it has until it is
/// whole, is another one than all others and than those that the command reads; links and "." in paths are
/// seen through.
void require_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

}  // namespace mssim
