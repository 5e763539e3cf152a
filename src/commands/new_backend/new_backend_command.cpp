#include "commands/new_backend/new_backend_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands/new_backend/starter.h"
#include "platform/files.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

struct NewBackendOptions {
  std::string name, out = ".";
  StarterLanguage language = StarterLanguage::python;
};

/// Whether the file is to be written. Throws UsageError where another one stands in its place.
bool is_wanted(const StarterFile& file, const fs::path& path) {
  std::error_code none;
  if (!fs::exists(fs::symlink_status(path, none))) return true;
  if (!file.shared)
    throw UsageError(printable(path.string(), 1000) + " already exists: give another name or --out");
  if (read_file(path) != file.text)
    throw UsageError(printable(path.string(), 1000) +
                     " is another version's than this mssim's: give another --out, or remove it");
  return false;
}

/// Whoever may read it may run it.
void make_executable(const fs::path& file) {
  const fs::perms readers = fs::status(file).permissions() &
                            (fs::perms::owner_read | fs::perms::group_read | fs::perms::others_read);
  fs::permissions(file, static_cast<fs::perms>(static_cast<unsigned>(readers) >> 2U), fs::perm_options::add);
}

int run_new_backend(const NewBackendOptions& options) {
  const fs::path folder = options.out;
  const Starter starter = starter_of(options.name, options.language, folder);
  std::vector<StarterFile> wanted;
  for (const StarterFile& file : starter.files)
    if (is_wanted(file, folder / file.name)) wanted.push_back(file);
  for (const StarterFile& file : wanted) {
    const fs::path path = folder / file.name;
    write_file_atomically(path, file.text);
    if (file.executable) make_executable(path);
    std::cerr << "mssim: wrote " << printable(path.string(), 1000) << '\n';
  }
  for (const std::string& command : starter.commands) std::cout << command << '\n';
  return exit_ok;
}

}  // namespace

std::function<int()> declare_new_backend(Arguments& arguments) {
  const auto options = std::make_shared<NewBackendOptions>();
  arguments.add("NAME", options->name, "Name of the backend; its file is NAME.py or NAME.cpp").required();
  arguments
      .add_choice(
          "--language", options->language,
          {{"python", StarterLanguage::python}, {"c++", StarterLanguage::cpp}},
          "What to write: python, one file that needs NumPy and h5py; c++, one file and a header that "
          "needs HDF5's C library")
      .required();
  arguments.add("--out", options->out, "Folder to write into (default: this one)").value_name("DIR");
  return [options] { return run_new_backend(*options); };
}

}  // namespace mssim
