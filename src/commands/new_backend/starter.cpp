#include "commands/new_backend/starter.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "backends/backends.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// The name of the examples, which gives way to the new one's.
constexpr std::string_view example_name = "my_backend";

/// What a program of one of these names would import instead of the module that it needs.
constexpr std::array<std::string_view, 3> needed_modules{"mssim_backend", "numpy", "h5py"};

/// Whether the Python in PATH has a module of that name, of its library or installed: the program's folder
/// goes before those, so that what the example imports, and all that this imports, would get the program
/// instead. False where there is no Python, which would run no such program either.
bool is_module_of_python(const std::string& name) {
  const auto python = find_program("python3");
  if (!python || name.find('-') != std::string::npos) return false;  // `import a-b` is none
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
  if (find_backend(name) != nullptr)
    throw UsageError("mssim has a backend " + name + " already (mssim list backends): give another name");
  if (std::ranges::find(needed_modules, name) != needed_modules.end())
    throw UsageError(name + " is the name of a module that backends need: give another name");
}

/// The text of an example, with the name of the new backend in it.
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

}  // namespace

Starter starter_of(const std::string& name, StarterLanguage language, const fs::path& folder) {
  require_usable(name);
  const fs::path program = folder / name;
  if (language == StarterLanguage::python) {
    if (is_module_of_python(name))
      throw UsageError(name + " is the name of a module of python3, which would be imported from " + name +
                       ".py by all that needs it: give another name, my_" + name + " say");
    const std::string file = name + ".py";
    return {{{file, example_for(name, ".py"), true}}, {bench_command(folder / file)}};
  }
  const std::string file = name + ".cpp", header = "mssim_backend.h";
  return {
      {{file, example_for(name, ".cpp")}, {header, read_file(data_folder() / "cpp" / header), false, true}},
      {"c++ -std=c++17 -O3 " + shell_word((folder / file).string()) +
           " $(pkg-config --cflags --libs hdf5) -o " + shell_word(program.string()),
       bench_command(program)}};
}

}  // namespace mssim
