#pragma once

#include <filesystem>
#include <string>
#include <string_view>
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

/// Throws UsageError where the name of a file that gets `content`, for example "PNG", ends as that of
/// another kind of file does: neither in nothing nor in one of these, the first of which is proposed.
void require_extension(const NamedFile& file, const std::string& content,
                       const std::vector<std::string_view>& extensions);

}  // namespace mssim
