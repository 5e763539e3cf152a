#include "application/choices.h"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "backends/described/backend_description.h"
#include "backends/devices/drivers.h"
#include "backends/process/process_backend.h"
#include "bench/results/result.h"
#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Number of processors that the process may use, limited by a container's quota of processor time.
int usable_processors() {
  const int processors = omp_get_num_procs();
  const std::optional<double> quota = container_limits().processors;
  return quota ? std::min(processors, static_cast<int>(std::ceil(*quota))) : processors;
}

namespace fs = std::filesystem;

constexpr std::string_view description_extension = ".json";

/// What follows the colon in hybrid:each.
constexpr std::string_view each_word = each_suffix.substr(1);

/// What follows the colon in serial:double and openmp:double.
constexpr std::string_view double_word = "double";

/// The folder of the descriptions that come with mssim.
fs::path shipped_folder() { return data_folder() / "backends"; }

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// A link that leads nowhere counts: whoever reads it says so.
bool is_file_or_link(const fs::path& path) {
  std::error_code error;
  return is_file(path) || fs::is_symlink(path, error);
}

/// Whether both are the same file or folder, however their paths are written.
bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return a == b || fs::equivalent(a, b, error);
}

/// Whether both run the same program in the same way.
bool is_same(const BackendProgram& a, const BackendProgram& b) {
  const auto arguments = [](const BackendProgram& program) { return std::span(program.command).subspan(1); };
  return (a.command == b.command ||
          (is_same(a.program, b.program) && std::ranges::equal(arguments(a), arguments(b)))) &&
         is_same(a.folder, b.folder) && a.environment == b.environment;
}

bool is_path(const std::string& name) { return name.find('/') != std::string::npos; }

std::string shown(const fs::path& path) { return escaped(path.string()); }

/// Throws UsageError for a name that --backend could not tell from others, and what read_description throws.
BackendProgram described_by(const fs::path& file) {
  BackendProgram program = read_description(file);
  if (program.name.find_first_of(":,") != std::string::npos)
    throw UsageError(
        "{}: in the name of a backend \":\" and \",\" have a meaning (--backend a:2,b): rename it",
        shown(file));
  return program;
}

/// The program at a path from the command line.
BackendProgram program_at(const std::string& path) {
  if (const std::string file = path.substr(0, path.rfind(':')); !is_file(path) && is_file(file))
    throw UsageError(
        "{} has a suffix, which the path of a program does not take: give {}, and several numbers of threads "
        "as --threads 1,2",
        escaped(path), escaped(file));
  if (!is_file(path))
    throw MissingProgram("there is no program " + escaped(path) +
                         ": give the path of a program, or a name (see mssim list backends)");
  const std::string extension = to_lower(fs::path(path).extension().string());
  if (extension == ".c" || extension == ".cc" || extension == ".cpp")
    throw MissingProgram("{} is the source of a program: compile it, and give the path of the program",
                         escaped(path));
  if (::access(path.c_str(), X_OK) != 0)
    throw MissingProgram(escaped(path) + " may not be executed; chmod +x it, or describe how it is run");
  BackendProgram program;
  program.program = fs::absolute(path);
  program.name = row_name(path);
  program.description = "the program " + escaped(path);
  program.command = {path};
  program.folder = fs::current_path();
  return program;
}

/// Like require_instruction_set, but nothing if there is none of that name.
std::optional<std::string_view> instruction_set_named(std::string_view name) {
  for (const std::string_view set : instruction_sets())
    if (name == set || name == instruction_set_name(set)) return set;
  return std::nullopt;
}

/// Whether a suffix of the row may be a number of threads.
bool takes_number(const BackendInfo& row) { return row.makes_threads || row.uses_device; }

/// Throws UsageError with the suffixes that the row takes, of which `how` is none.
[[noreturn]] void refuse_suffix(const std::string& name, const std::string& how, const BackendInfo& row) {
  const std::string number = fmt::format("a number from 1 to {}", most_threads);
  std::vector<std::string_view> known;
  if (!row.each_body && !row.in_double) known.push_back(each_word);
  if (row.make_in_double != nullptr && !row.in_double) known.push_back(double_word);
  for (const std::string_view set : row.has_vectors ? instruction_sets() : std::vector<std::string_view>())
    known.push_back(instruction_set_name(set));
  if (takes_number(row)) known.push_back(number);
  if (known.empty())
    throw UsageError("{} has a suffix, which {} does not take: leave \":{}\" out", printable(name), row.name,
                     printable(how));
  throw UsageError(printable(name) + ": " + unknown_name("suffix", how, known));
}

/// Throws UsageError for rows whose number of processes is not one of threads.
void refuse_list_with_ranks(const std::vector<const BackendInfo*>& rows, std::string_view option) {
  for (const BackendInfo* info : rows)
    if (info->program && info->program->in_ranks)
      throw UsageError("a list of {} cannot be used with {}, which takes processes: leave one of them out",
                       option, info->name);
}

/// Whether the number of threads changes how the backend steps; it does not affect a device with its own
/// processors.
bool has_threads(const BackendInfo& info, const ExecutionOptions& execution) {
  if (info.threads > 0) return false;  // its name determines them
  if (info.makes_threads || info.program) return true;
  try {
    return info.uses_device && find_opencl_device(execution.device).type == OpenclDeviceType::cpu;
  } catch (const Unavailable&) {
    return false;
  }
}

/// What says that number of threads: `asked`, or else --threads.
std::string shown_request(int threads, std::string_view asked) {
  return asked.empty() ? fmt::format("--threads {}", threads) : printable(asked);
}

/// Throws UsageError for more threads than OpenMP would make.
void require_within_limit(int threads, std::string_view asked = {}) {
  if (const int limit = omp_get_thread_limit(); threads > limit)
    throw UsageError("{} is more than OMP_THREAD_LIMIT allows, {}; give fewer, or unset it",
                     shown_request(threads, asked), limit);
}

}  // namespace

const Integrator& require_integrator(const std::string& name) {
  if (const Integrator* integrator = find_integrator(name)) return *integrator;
  throw UsageError(
      unknown_name("integrator", name, mapped<std::string_view>(all_integrators, &Integrator::name)));
}

std::vector<const Integrator*> chosen_integrators(const std::vector<std::string>& asked,
                                                  std::span<const std::string_view> by_default) {
  const std::vector<std::string> names =
      asked.empty() ? std::vector<std::string>(by_default.begin(), by_default.end()) : asked;
  if (names == std::vector<std::string>{"all"}) return {all_integrators.begin(), all_integrators.end()};
  std::vector<const Integrator*> named, chosen;
  if (std::ranges::find(names, "all") != names.end())
    throw UsageError("--integrator all stands for every integrator: give no other name with it");
  for (const std::string& name : names) named.push_back(&require_integrator(name));
  for (const Integrator* integrator : all_integrators)
    if (std::ranges::find(named, integrator) != named.end()) chosen.push_back(integrator);
  return chosen;
}

std::string_view require_instruction_set(const std::string& name) {
  if (const auto set = instruction_set_named(name)) return *set;
  throw UsageError(unknown_name("instruction set", name,
                                mapped<std::string_view>(instruction_sets(), instruction_set_name)));
}

std::string name_of(DeviceMemory memory) { return memory == DeviceMemory::copy ? "copy" : "shared"; }
std::string name_of(Roots roots) { return roots == Roots::exact ? "exact" : "fast"; }

void require_few_threads(int threads, std::string_view asked) {
  if (const auto excess = thread_excess(threads))
    throw UsageError("{} is {}", shown_request(threads, asked), *excess);
  require_within_limit(threads, asked);
}

ExecutionOptions complete(ExecutionOptions options) {
  options.threads_given = options.threads > 0;
  if (!options.threads_given) options.threads = std::min(usable_processors(), omp_get_thread_limit());
  if (options.launcher.empty())
    require_few_threads(options.threads);
  else  // its hosts may have more processors
    require_within_limit(options.threads);
  if (!options.instruction_set.empty())
    options.instruction_set = require_instruction_set(options.instruction_set);
  omp_set_dynamic(0);
  return options;
}

bool is_shipped(const std::string& name) {
  return is_file(shipped_folder() / (name + std::string(description_extension)));
}

std::string row_name(const std::string& asked) {
  if (!is_path(asked)) return asked;
  const fs::path path = asked;
  return (path.extension() == description_extension ? path.stem() : path.filename()).string();
}

std::vector<const BackendInfo*> table_backends() {
  return mapped<const BackendInfo*>(backends(), [](const BackendInfo& row) { return &row; });
}

std::vector<const BackendInfo*> with_garment_backends(std::vector<const BackendInfo*> rows) {
  for (const BackendInfo& backend : garment_backends()) add_once(rows, &backend);
  return rows;
}

BackendChoice::Row::Row(BackendProgram its_program)
    : program(std::move(its_program)), info(own_backend(program)) {}

BackendChoice::Row::Row(const BackendInfo& of, std::string_view how)
    : name(fmt::format("{}:{}", of.name, how)), info(of) {
  info.name = name;
  if (how == each_word || how == double_word) {
    (how == each_word ? info.each_body : info.in_double) = true;
    if (info.in_double && info.has_vectors) info.step_share *= 2;  // half as many lanes
    info.role = BackendRole::as_published;
    info.make_dressing = nullptr;
  } else if (const auto threads = number_in<int>(how)) {
    info.threads = *threads;
  } else {
    info.instruction_set = instruction_set_named(how).value();
  }
}

BackendChoice::BackendChoice(std::vector<const BackendInfo*> known, const OwnBackendOptions& options,
                             const std::vector<std::string>& scenes)
    : known_(std::move(known)), limit_s_(options.limit_s) {
  for (const std::string& folder : options.folders) {
    std::error_code error;
    if (!fs::is_directory(folder, error))
      throw UsageError("--backend-folder {} is not a folder: give one with descriptions, NAME.json",
                       escaped(folder));
    folders_.emplace_back(folder);
  }
  if (const fs::path folder = xdg_folder("XDG_CONFIG_HOME", ".config"); !folder.empty())
    folders_.push_back(folder / "mssim" / "backends");
  for (const std::string& scene : scenes) {
    const fs::path folder = fs::path(scene).parent_path();
    if (is_path_of_scene(scene)) scene_folders_.push_back(folder.empty() ? fs::path(".") : folder);
  }
}

const BackendInfo& BackendChoice::require(const std::string& name) {
  if (is_path(name))
    return add(name.ends_with(description_extension) ? described_by(name) : program_at(name));
  const std::optional<fs::path> file = description_of(name);
  if (!file)
    if (const BackendInfo* row = variant(name)) {
      if (row->threads > 0) require_few_threads(row->threads, name);
      return *row;
    }
  const auto row = std::ranges::find(known_, name, &BackendInfo::name);
  if (row != known_.end()) return **row;
  if (file) return add(described_by(*file));
  const std::string before_colon = name.substr(0, name.find(':'));
  if (before_colon != name && std::ranges::find(known_, before_colon, &BackendInfo::name) != known_.end())
    throw UsageError(
        "{}: \"{}\" is not a suffix; give one suffix, or each, double or an instruction set and then a "
        "number, "
        "as in openmp:each:4",
        printable(name), printable(name.substr(before_colon.size())));
  std::vector<std::string> broken;  // not what was asked for
  std::vector<std::string_view> names;
  for (const BackendInfo* info : known_) names.push_back(info->name);
  for (const BackendInfo* info : described(&broken)) names.push_back(info->name);
  for (const BackendInfo* info : shipped(&broken)) names.push_back(info->name);
  if (is_file(name))
    throw UsageError("unknown backend \"{0}\": a program of your own is a path with a slash, ./{0}",
                     printable(name));
  if (const auto all = with_garment_backends(table_backends());
      std::ranges::find(all, name, &BackendInfo::name) != all.end())
    throw UsageError("backend {} does not go with this command or suite: give {}", name, listed(names, "or"));
  constexpr std::array<OtherName, 2> others{{{"gpu", "opencl"}, {"cuda", "opencl"}}};
  throw UsageError(unknown_name("backend", name, names, others));
}

const BackendInfo* BackendChoice::variant(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  if (colon == std::string::npos) return nullptr;
  const std::string its_name = name.substr(0, colon), how = name.substr(colon + 1);
  const auto in_table = std::ranges::find(known_, its_name, &BackendInfo::name);
  const std::string its_last = its_name.substr(its_name.rfind(':') + 1);
  const std::optional<std::string_view> set = instruction_set_named(how);
  const std::optional<int> number = number_in<int>(how);
  const bool is_of_variant = its_last == each_word     ? how != each_word
                             : its_last == double_word ? number || set
                                                       : number && instruction_set_named(its_last);
  const BackendInfo* row = in_table != known_.end() ? *in_table : is_of_variant ? variant(its_name) : nullptr;
  const auto require_number = [&](bool takes_one, std::string_view of_what, int most) {
    if (!takes_one)
      throw UsageError("{} has a {}, which {} does not take: leave \":{}\" out", printable(name),
                       number ? "number of ranks or threads" : "suffix", its_name, printable(how));
    if (!number || *number < 1 || *number > most)
      throw UsageError("{} has an invalid number of {}: give one from 1 to {}, as in {}:4{}", printable(name),
                       of_what, most, its_name,
                       row && row->has_vectors ? fmt::format(", or an instruction set, as in {}:{}", its_name,
                                                             instruction_set_name(instruction_sets().front()))
                                               : "");
  };
  if (row) {
    if (how == each_word) return &add_variant(*row, how);
    if (row->make_in_double != nullptr && how == double_word) return &add_variant(*row, how);
    if (row->has_vectors && set) return &add_variant(*row, instruction_set_name(*set));
    if (!number) refuse_suffix(name, how, *row);
    require_number(takes_number(*row), "threads", most_threads);
    return &add_variant(*row, std::to_string(*number));
  }
  const std::optional<fs::path> file = description_of(its_name);
  if (!file) return nullptr;
  if (how == each_word)
    throw UsageError(
        "{} asks for a step of each body for itself, which only mssim's own backends take: leave "
        "\":{}\" out",
        printable(name), each_word);
  BackendProgram program = described_by(*file);
  require_number(program.in_ranks, "ranks", most_ranks);
  program.ranks = *number;
  program.name = fmt::format("{}:{}", its_name, *number);
  return &add(program);
}

const BackendInfo& BackendChoice::add_variant(const BackendInfo& info, std::string_view how) {
  auto row = std::make_unique<Row>(info, how);
  for (const std::unique_ptr<Row>& known : rows_)
    if (known->info.name == row->name) return known->info;
  return rows_.emplace_back(std::move(row))->info;
}

std::vector<const BackendInfo*> BackendChoice::with_variants(const std::vector<const BackendInfo*>& rows,
                                                             std::span<const std::string_view> names) {
  std::vector<const BackendInfo*> all;
  for (const BackendInfo* row : rows) {
    all.push_back(row);
    for (const std::string_view name : names)
      if (is_variant(name, row->name)) all.push_back(variant(std::string(name)));
  }
  return all;
}

std::vector<const BackendInfo*> BackendChoice::with_lesser_sets(const std::vector<const BackendInfo*>& rows,
                                                                const std::vector<std::string_view>& sets) {
  if (sets.size() > 1) refuse_list_with_ranks(rows, "--instruction-set");
  std::vector<const BackendInfo*> all;
  for (const BackendInfo* info : rows) {
    for (std::size_t i = sets.size(); info->has_vectors && info->instruction_set.empty() && i-- > 1;)
      if (const BackendInfo* row = &add_variant(*info, instruction_set_name(sets[i]));
          std::ranges::find(rows, row) == rows.end())  // named by itself, too
        all.push_back(row);
    all.push_back(info);
  }
  return all;
}

std::vector<const BackendInfo*> BackendChoice::with_fewer_threads(const std::vector<const BackendInfo*>& rows,
                                                                  std::vector<int> counts,
                                                                  const ExecutionOptions& execution) {
  std::ranges::sort(counts);
  std::erase_if(counts, [&](int count) { return count >= execution.threads; });
  if (!counts.empty()) refuse_list_with_ranks(rows, "--threads");
  std::vector<const BackendInfo*> all;
  for (const BackendInfo* info : rows) {
    if (!counts.empty() && has_threads(*info, execution))
      for (const int count : counts)
        if (const BackendInfo* row = &add_variant(*info, std::to_string(count));
            std::ranges::find(rows, row) == rows.end())  // named by itself, too
          all.push_back(row);
    all.push_back(info);
  }
  return all;
}

std::vector<const BackendInfo*> BackendChoice::require_all(const std::vector<std::string>& names) {
  std::vector<const BackendInfo*> asked, rows;
  for (const std::string& name : names) asked.push_back(&require(name));
  for (const BackendInfo* row : known_)
    if (std::ranges::find(asked, row) != asked.end()) rows.push_back(row);
  // Not own(): NAME:each:2 has made NAME:each on the way.
  for (const BackendInfo* row : asked) add_once(rows, row);
  return rows;
}

std::vector<const BackendInfo*> BackendChoice::shipped(std::vector<std::string>* broken) {
  return described_in({shipped_folder()}, broken);
}

std::vector<const BackendInfo*> BackendChoice::described_in(const std::vector<fs::path>& folders,
                                                            std::vector<std::string>* broken) {
  std::vector<fs::path> files;
  for (const fs::path& folder : folders)
    for (const fs::path& file : entries_of(folder))
      if (file.extension() == description_extension && is_file_or_link(file)) files.push_back(file);
  std::ranges::sort(files, {}, [](const fs::path& file) { return file.stem(); });
  std::vector<const BackendInfo*> infos;
  for (const fs::path& file : files) {
    try {
      add_once(infos, &require(file.stem().string()));  // a folder may be given twice
    } catch (const Error& error) {
      if (broken == nullptr) throw;
      add_once(*broken, error.what());  // two of one name have one reason
    }
  }
  return infos;
}

std::vector<const BackendInfo*> BackendChoice::own() const {
  return mapped<const BackendInfo*>(rows_, [](const std::unique_ptr<Row>& row) { return &row->info; });
}

std::optional<fs::path> BackendChoice::description_of(const std::string& name) const {
  const bool in_table = std::ranges::find(known_, name, &BackendInfo::name) != known_.end();
  std::vector<fs::path> found;
  const auto look = [&](const fs::path& folder) {
    const fs::path file = folder / (name + std::string(description_extension));
    std::error_code error;
    const bool known =
        std::ranges::any_of(found, [&](const fs::path& other) { return fs::equivalent(other, file, error); });
    if (is_file_or_link(file) && !known) found.push_back(file);
  };
  std::ranges::for_each(folders_, look);
  if (in_table && !found.empty())
    throw UsageError("{} has the same name as mssim's backend {}; rename it", shown(found.front()), name);
  // A scene file may have any name.
  if (!in_table) std::ranges::for_each(scene_folders_, look);
  look(shipped_folder());
  if (found.size() > 1)
    throw UsageError("there are two backends called {}, {} and {}; rename one of them", escaped(name),
                     shown(found[0]), shown(found[1]));
  return found.empty() ? std::nullopt : std::optional(found.front());
}

const BackendInfo& BackendChoice::add(BackendProgram program) {
  if (escaped(program.name) != program.name)
    throw UsageError("a backend cannot be called {}: its name has characters that cannot be shown; rename it",
                     escaped(program.name));
  // Its name may be a row's, openmp:1.
  const std::string before_colon = program.name.substr(0, program.name.find(':'));
  if (std::ranges::find(known_, before_colon, &BackendInfo::name) != known_.end() ||
      (is_shipped(before_colon) && !is_same(program.folder, shipped_folder())))
    throw UsageError("{} has the same name as mssim's backend {}; rename it", shown(program.program),
                     program.name);
  for (const std::unique_ptr<Row>& row : rows_) {
    if (row->program.name != program.name) continue;
    if (is_same(row->program, program)) return row->info;
    throw UsageError("there are two backends called {}, {} and {}; rename one of them", program.name,
                     shown(row->program.program), shown(program.program));
  }
  if (limit_s_) program.time_limit_s = *limit_s_;
  return rows_.emplace_back(std::make_unique<Row>(std::move(program)))->info;
}

void add_execution(Provenance& provenance, const std::vector<const BackendInfo*>& rows,
                   const ExecutionOptions& execution) {
  provenance.device_memory = name_of(execution.memory);
  provenance.roots = name_of(execution.roots);
  provenance.instruction_set = execution.instruction_set;
  for (const BackendInfo* info : rows) {
    const BackendProgram* program = info->program;
    if (!program || info->threads > 0) continue;  // the row with the requested number has the program
    BackendProgramRecord record{.name = program->name, .command = program->command};
    for (const std::string& variable : program->environment) {
      const std::size_t equals = variable.find('=');
      record.environment.emplace_back(variable.substr(0, equals), variable.substr(equals + 1));
    }
    if (program->in_ranks) {
      const RankCount count = ranks_of(*program, execution);
      record.ranks = count.ranks;
      record.rank_threads = count.threads;
      record.launcher = execution.launcher;
    }
    add_program(provenance, std::move(record), program->program, program->folder);
  }
}

void require_use_of_options(const ExecutionOptions& given, const std::vector<const BackendInfo*>& rows) {
  const auto require = [&](std::string_view option, bool is_given, std::string_view backends,
                           std::string_view one, const auto& uses) {
    if (is_given && std::ranges::none_of(rows, uses))
      throw UsageError("{} is for backends {}, and none of these does: add --backend {}, or leave it out",
                       option, backends, one);
  };
  const auto in_ranks = [](const BackendInfo* info) { return info->program && info->program->in_ranks; };
  require("--ranks", given.ranks > 0, "that run in several processes", "mpi", in_ranks);
  require("--launcher", !given.launcher.empty(), "that run in several processes", "mpi", in_ranks);
  require("--device", !given.device.empty(), "that use OpenCL", "opencl", &BackendInfo::uses_device);
  require("--instruction-set", !given.instruction_set.empty(), "that have vector code per set", "openmp",
          [&](const BackendInfo* info) { return info->has_vectors || in_ranks(info); });
  if (!given.device.empty()) find_opencl_device(given.device);
}

int most_ranks_of(const std::vector<const BackendInfo*>& rows, const ExecutionOptions& execution) {
  int most = 1;
  for (const BackendInfo* info : rows)
    if (info->program && info->program->in_ranks)
      most = std::max(most, ranks_of(*info->program, execution).ranks);
  return most;
}

}  // namespace mssim
