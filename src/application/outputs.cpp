#include "application/outputs.h"

#include <algorithm>
#include <iterator>
#include <system_error>

#include "backends/devices/drivers.h"
#include "mesh/tetgen.h"
#include "output/folders/provenance_file.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// The path without links, "." and "..", as far as it exists; a link may lead to a file that does not exist
/// yet.
fs::path resolved(const fs::path& path) {
  std::error_code error;
  fs::path absolute = fs::absolute(path, error);
  constexpr int most_links = 40;  // as many as Linux follows
  for (int links = 0; links < most_links && fs::is_symlink(absolute, error); ++links)
    absolute = absolute.parent_path() / fs::read_symlink(absolute, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

/// A rename replaces a link rather than its target, so such a file has two names.
bool is_same(const fs::path& a, const fs::path& b) {
  const auto in_its_folder = [](const fs::path& path) {
    return resolved(path.has_parent_path() ? path.parent_path() : fs::path(".")) / path.filename();
  };
  std::error_code error;
  return in_its_folder(a) == in_its_folder(b) || resolved(a) == resolved(b) || fs::equivalent(a, b, error);
}

/// Throws UsageError if `written`, or its temporary, would replace the other file.
void require_other(const NamedFile& written, const NamedFile& other) {
  const NamedFile temporary{"the temporary file of " + written.role, temporary_of(written.path)};
  for (const NamedFile& file : {written, temporary})
    if (is_same(file.path, other.path))
      throw UsageError("{} and {} are the same file, {}; give them different names", file.role, other.role,
                       printable(file.path.string()));
}

std::vector<std::string>& arguments() {
  static std::vector<std::string> remembered;
  return remembered;
}

}  // namespace

void require_extension(const NamedFile& file, const std::string& content,
                       const std::vector<std::string_view>& extensions) {
  const std::string extension = file.path.extension().string();
  if (extension.empty() || std::ranges::find(extensions, to_lower(extension)) != extensions.end()) return;
  throw UsageError("{} is {}, but what is written is {}: give {}", file.role,
                   printable(file.path.string(), 1000), content,
                   printable(fs::path(file.path).replace_extension(extensions.front()).string(), 1000));
}

void require_distinct(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  for (auto file = written.begin(); file != written.end(); ++file) {
    for (auto other = file + 1; other != written.end(); ++other) {
      require_other(*file, *other);
      require_other(*other, *file);
    }
    for (const NamedFile& input : read) require_other(*file, input);
  }
}

void remember_arguments(int argc, char** argv) { arguments().assign(argv, argv + argc); }

Provenance run_provenance(int threads, bool uses_device) {
  Provenance provenance = gather_provenance(arguments(), threads);
  if (uses_device) {
    const OpenclOffer& offer = opencl_offer();
    for (const OpenclDevice& device : offer.devices)
      provenance.opencl_devices.push_back(
          fmt::format("{}: {}, driver {}", device.platform, device.name, device.driver_version));
    std::ranges::copy(offer.troubles, std::back_inserter(provenance.opencl_devices));
  }
  try {
    if (const auto tetgen = find_tetgen())
      provenance.tetgen = fmt::format("{}, fnv1a_64 {}", tetgen->version, to_hex(tetgen->fnv1a_64));
  } catch (const MissingProgram&) {  // a scene that needs it says why
    provenance.tetgen = "cannot be started";
  }
  return provenance;
}

TraceHeader trace_header(const PreparedScene& scene, const Backend& backend, const BackendInfo& info,
                         const Integrator& integrator, const Provenance& provenance) {
  TraceHeader header;
  header.creator_version = build_info().version;
  header.scene_json = scene.spec.source;
  header.provenance_json = provenance_text(provenance);
  header.backend = fmt::format("{} on {}", info.name, backend.device());
  header.integrator = integrator.name;
  header.dt_s = scene.dt_s;
  header.in_double = info.in_double;
  return header;
}

}  // namespace mssim
