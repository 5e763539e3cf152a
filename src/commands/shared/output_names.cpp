#include "commands/shared/output_names.h"

#include <algorithm>
#include <system_error>

#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Without links, "." and "..", as far as the path exists; a link may lead to what does not exist yet.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  constexpr int most_links = 40;  // as many as Linux follows
  for (int links = 0; links < most_links && fs::is_symlink(absolute, error); ++links)
    absolute = absolute.parent_path() / fs::read_symlink(absolute, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

/// A rename replaces a link, not what it leads to: such a file goes by two names.
bool is_same(const fs::path& a, const fs::path& b) {
  const auto in_its_folder = [](const fs::path& path) {
    return resolved(path.has_parent_path() ? path.parent_path() : fs::path(".")) / path.filename();
  };
  std::error_code error;
  return in_its_folder(a) == in_its_folder(b) || resolved(a) == resolved(b) || fs::equivalent(a, b, error);
}

void require_other(const NamedFile& a, const NamedFile& b) {
  if (is_same(a.path, b.path))
    throw UsageError(a.role + " and " + b.role + " are the same file, " + printable(a.path.string()) +
                     "; give them different names");
}

}  // namespace

void require_extension(const NamedFile& file, const std::string& content,
                       const std::vector<std::string_view>& extensions) {
  const std::string extension = file.path.extension().string();
  if (extension.empty() || std::ranges::find(extensions, to_lower(extension)) != extensions.end()) return;
  throw UsageError(file.role + " is " + printable(file.path.string(), 1000) + ", but what is written is " +
                   content + ": give " + printable(file.path.stem().string(), 1000) +
                   std::string(extensions.front()));
}

void require_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  for (auto file = written.begin(); file != written.end(); ++file) {
    for (auto other = file + 1; other != written.end(); ++other) {
      require_other(*file, *other);
      for (const auto& [under_way, whole] : {std::pair(*file, *other), std::pair(*other, *file)})
        require_other({"the temporary file of " + under_way.role, temporary_of(under_way.path)}, whole);
    }
    for (const NamedFile& input : read) require_other(*file, input);
  }
}

}  // namespace mssim
