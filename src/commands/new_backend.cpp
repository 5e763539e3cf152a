#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <vector>

#include "application/choices.h"
#include "application/console.h"
#include "backends/backends.h"
#include "commands/command.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Language of a starter.
enum class StarterLanguage : std::uint8_t { python, cpp };

/// A file of a starter.
struct StarterFile {
  fs::path name;
  std::string text;
  bool executable = false;
  bool shared = false;  ///< identical for every backend; an existing identical file is kept
};

/// A backend to start from: a working example with its other files, and commands that use it.
struct Starter {
  std::vector<StarterFile> files;
  std::vector<std::string> commands;  ///< for a shell, in order of use
};

/// The name in the examples, which is replaced by the new name.
constexpr std::string_view example_name = "my_backend";

/// Modules that a backend needs; a program of such a name would be imported instead of the module.
constexpr std::array<std::string_view, 3> needed_modules{"mssim_backend", "numpy", "h5py"};

/// Whether the Python in PATH has a module of that name, in its library or installed. The program's folder is
/// searched first, so the imports of the example would find the program instead. False without a Python that
/// runs, which could not run such a program either.
bool is_module_of_python(const std::string& name) {
  const auto python = find_program("python3");
  if (!python || name.find('-') != std::string::npos) return false;  // `import a-b` is none
  try {
    const ChildResult result = run({*python,
                                    {"-I", "-c",
                                     "import importlib.util, sys; "
                                     "print('module', importlib.util.find_spec(sys.argv[1]) is not None)",
                                     name},
                                    {},
                                    "/",
                                    60,
                                    60});
    return result.output.find("module True") != std::string::npos;
  } catch (const MissingProgram&) {
    return false;
  }
}

void require_usable(const std::string& name) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  constexpr std::size_t longest = 64;
  const bool starts_well = !name.empty() && letters.find(name.front()) != std::string_view::npos;
  if (!starts_well || name.size() > longest ||
      name.find_first_not_of(std::string(letters) + "0123456789_-") != std::string::npos)
    throw UsageError("\"" + printable(name) +
                     "\" cannot be a backend's name: give at most 64 letters, digits, _ and -, the first a "
                     "letter, without .py or .cpp");
  if (find_backend(name) != nullptr || is_shipped(name))
    throw UsageError("mssim has a backend {} already (mssim list backends): give another name", name);
  if (std::ranges::find(needed_modules, name) != needed_modules.end())
    throw UsageError(name + " is the name of a module that backends need: give another name");
}

/// The text of an example, with the name of the new backend.
std::string example_for(const std::string& name, std::string_view extension) {
  std::string text = read_file(data_folder() / "examples" / (std::string(example_name).append(extension)));
  for (std::size_t at = text.find(example_name); at != std::string::npos;
       at = text.find(example_name, at + name.size()))
    text.replace(at, example_name.size(), name);
  return text;
}

std::string bench_command(const fs::path& program) {
  return "mssim bench --scene cloth2500 --backend " + shell_word("serial,openmp," + program.string());
}

/// The starter with that name, whose files are to be in `folder`. Throws UsageError for a name that would not
/// work.
Starter starter_of(const std::string& name, StarterLanguage language, const fs::path& folder) {
  require_usable(name);
  const fs::path program = folder / name;
  if (language == StarterLanguage::python) {
    if (is_module_of_python(name))
      throw UsageError(name + " is the name of a module of python3, which would be imported from " + name +
                       ".py by programs that need it: choose my_" + name + " for example");
    const std::string file = name + ".py";
    return {{{file, example_for(name, ".py"), true}}, {bench_command(folder / file)}};
  }
  const std::string file = name + ".cpp", header = "mssim_backend.h";
  return {
      {{file, example_for(name, ".cpp")}, {header, read_file(data_folder() / "cpp" / header), false, true}},
      {fmt::format("c++ -std=c++17 -O3 {} $(pkg-config --cflags --libs hdf5) -o {}",
                   shell_word((folder / file).string()), shell_word(program.string())),
       bench_command(program)}};
}

struct NewBackendOptions {
  std::string name, out = ".";
  StarterLanguage language = StarterLanguage::python;
};

/// Whether the file must be written. Throws UsageError if another file has its name.
bool is_wanted(const StarterFile& file, const fs::path& path) {
  std::error_code none;
  if (!fs::exists(fs::symlink_status(path, none))) return true;
  if (!file.shared)
    throw UsageError(printable(path.string(), 1000) + " already exists: give another name or --out");
  if (read_file(path) != file.text)
    throw UsageError(printable(path.string(), 1000) +
                     " is from another version of mssim: give another --out, or remove it");
  return false;
}

/// Allows everyone who may read the file to run it.
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
    tell("wrote {}", printable(path.string(), 1000));
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
          "Language: python (one file; needs NumPy and h5py) or c++ (one file and a header; needs HDF5's "
          "C library)")
      .required();
  arguments.add("--out DIR", options->out, "Folder to write into (default: the working folder)");
  return [options] { return run_new_backend(*options); };
}

}  // namespace mssim
