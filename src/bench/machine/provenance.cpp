#include "bench/machine/provenance.h"

#include <omp.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::string_view amd = "AuthenticAMD", intel = "GenuineIntel", arm = "0x41";

struct Generation {
  std::string_view maker;
  int family;
  int first_model, last_model;
  std::string_view name;
};

/// Numbers by which the kernel distinguishes x86 processors (arch/x86/kernel/cpu/amd.c and
/// asm/intel-family.h), and those of Arm's main ID registers.
constexpr Generation generations[]{
    {amd, 0x17, 0x00, 0x2f, "Zen"},           {amd, 0x17, 0x50, 0x5f, "Zen"},
    {amd, 0x17, 0x30, 0x4f, "Zen 2"},         {amd, 0x17, 0x60, 0x7f, "Zen 2"},
    {amd, 0x17, 0x90, 0xaf, "Zen 2"},         {amd, 0x19, 0x00, 0x0f, "Zen 3"},
    {amd, 0x19, 0x20, 0x5f, "Zen 3"},         {amd, 0x19, 0x10, 0x1f, "Zen 4"},
    {amd, 0x19, 0x60, 0xaf, "Zen 4"},         {amd, 0x1a, 0x00, 0x4f, "Zen 5"},
    {amd, 0x1a, 0x60, 0x7f, "Zen 5"},         {intel, 6, 0x3f, 0x3f, "Haswell"},
    {intel, 6, 0x4f, 0x4f, "Broadwell"},      {intel, 6, 0x55, 0x55, "Skylake or Cascade Lake"},
    {intel, 6, 0x6a, 0x6a, "Ice Lake"},       {intel, 6, 0x6c, 0x6c, "Ice Lake"},
    {intel, 6, 0x8c, 0x8d, "Tiger Lake"},     {intel, 6, 0x8f, 0x8f, "Sapphire Rapids"},
    {intel, 6, 0x97, 0x97, "Alder Lake"},     {intel, 6, 0x9a, 0x9a, "Alder Lake"},
    {intel, 6, 0xad, 0xae, "Granite Rapids"}, {intel, 6, 0xb7, 0xb7, "Raptor Lake"},
    {intel, 6, 0xcf, 0xcf, "Emerald Rapids"}, {arm, 0, 0xd0c, 0xd0c, "Neoverse N1"},
    {arm, 0, 0xd40, 0xd40, "Neoverse V1"},    {arm, 0, 0xd49, 0xd49, "Neoverse N2"},
    {arm, 0, 0xd4f, 0xd4f, "Neoverse V2"},
};

namespace fs = std::filesystem;

/// First line of a file; empty if it cannot be read.
std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\"";
  const std::size_t first = text.find_first_not_of(blank);
  return first == std::string_view::npos ? std::string_view{}
                                         : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Value of the first "KEY<separator>VALUE" line of a file, without blanks and quotes.
std::string value_of(const fs::path& file, std::string_view key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string_view view = line;
    const std::size_t at = view.find(separator);
    if (at != std::string_view::npos && trimmed(view.substr(0, at)) == key)
      return std::string(trimmed(view.substr(at + 1)));
  }
  return {};
}

/// Number at the start of the text; 0 if there is none.
template <class Number>
Number leading_number(std::string_view text) {
  Number number{};
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

/// Value of a text such as "0xd0c"; 0 if it is not a number.
int hexadecimal_number(std::string_view text) {
  int number = 0;
  if (text.starts_with("0x")) std::from_chars(text.data() + 2, text.data() + text.size(), number, 16);
  return number;
}

/// Number of logical CPUs in a list of the kernel such as "0-3,8".
int count_cpus(const std::string& list) {
  int count = 0;
  std::istringstream ranges(list);
  for (std::string range; std::getline(ranges, range, ',');) {
    const std::size_t dash = range.find('-');
    const int first = leading_number<int>(range);
    count += dash == std::string::npos ? 1 : leading_number<int>(range.substr(dash + 1)) - first + 1;
  }
  return count;
}

/// Size of a cache in bytes, from the kernel's notation: "48K", "1024K", "32M".
std::uint64_t bytes_of(const std::string& size) {
  const auto number = leading_number<std::uint64_t>(size);
  const std::size_t unit = size.empty() ? std::string::npos : std::string_view("KMG").find(size.back());
  return unit == std::string::npos ? number : number << 10 * (unit + 1);
}

std::vector<Cache> read_caches(const fs::path& cpus) {
  std::map<std::tuple<int, std::string, std::uint64_t, int>, int> counts;  // of level, type, bytes, sharing
  std::set<std::tuple<std::string, std::string, std::string>> seen;  // level, type, the CPUs that share it
  for (const fs::path& cpu : entries_of(cpus))
    for (const fs::path& cache : entries_of(cpu / "cache")) {
      const std::string level = first_line(cache / "level"), type = first_line(cache / "type");
      const std::string shared = first_line(cache / "shared_cpu_list");
      if (level.empty() || !seen.emplace(level, type, shared).second) continue;
      ++counts[{leading_number<int>(level), type, bytes_of(first_line(cache / "size")), count_cpus(shared)}];
    }
  std::vector<Cache> caches;
  for (const auto& [kind, count] : counts) {
    const auto& [level, type, bytes, sharing] = kind;
    caches.push_back({level, type, bytes, count, sharing});
  }
  return caches;
}

/// Drivers report either whether boost is on, or whether turbo is off.
std::optional<bool> read_turbo(const fs::path& cpus) {
  if (const std::string boost = first_line(cpus / "cpufreq/boost"); !boost.empty()) return boost == "1";
  if (const std::string off = first_line(cpus / "intel_pstate/no_turbo"); !off.empty()) return off == "0";
  return std::nullopt;
}

std::vector<double> read_load(const fs::path& file) {
  std::ifstream in(file);
  std::vector<double> averages;
  for (double average = 0; averages.size() < 3 && in >> average;) averages.push_back(average);
  return averages;
}

std::string kernel_name() {
  utsname name{};
  return uname(&name) == 0 ? std::string(name.sysname) + ' ' + name.release + ' ' + name.machine
                           : std::string();
}

/// Design of the first processor in a file such as /proc/cpuinfo.
std::string read_generation(const fs::path& file) {
  const std::string vendor = value_of(file, "vendor_id", ':');
  if (!vendor.empty())
    return std::string(cpu_generation(vendor, leading_number<int>(value_of(file, "cpu family", ':')),
                                      leading_number<int>(value_of(file, "model", ':'))));
  const std::string implementer = value_of(file, "CPU implementer", ':');
  const std::string part = value_of(file, "CPU part", ':');  // "0xd0c"
  return std::string(cpu_generation(implementer, 0, hexadecimal_number(part)));
}

std::vector<std::pair<std::string, std::string>> thread_environment() {
  std::vector<std::pair<std::string, std::string>> variables;
  for (char** entry = environ; entry && *entry; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != std::string_view::npos && (text.starts_with("OMP_") || text.starts_with("GOMP_")))
      variables.emplace_back(escaped(text.substr(0, equals)), escaped(text.substr(equals + 1)));
  }
  std::sort(variables.begin(), variables.end());
  return variables;
}

/// The name of the home folder is usually the user's name.
std::string without_home(std::string_view argument) {
  const std::string folder = variable("HOME");
  if (folder.size() < 2) return std::string(argument);
  std::string result;
  for (std::size_t at = 0; at < argument.size();) {
    const std::string_view rest = argument.substr(at);
    if (rest.starts_with(folder) && (rest.size() == folder.size() || rest[folder.size()] == '/')) {
      result += '~';
      at += folder.size();
    } else {
      result += argument[at++];
    }
  }
  return result;
}

/// Hash of a file; none if it is not a regular file. Of a file that is longer than `most_bytes` or cannot be
/// read, the hash is of its size and the time of its last change.
std::optional<std::uint64_t> file_hash(const fs::path& file, std::uintmax_t most_bytes = UINTMAX_MAX) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (std::ifstream in(file, std::ios::binary); in.is_open() && bytes <= most_bytes) {
    std::uint64_t hash = fnv1a_64("");
    std::vector<char> block(std::size_t{1} << 20);
    do {
      in.read(block.data(), std::ssize(block));
      hash = fnv1a_64({block.data(), static_cast<std::size_t>(in.gcount())}, hash);
    } while (in);
    return hash;
  }
  return fnv1a_64(fmt::format("{} {}", bytes, fs::last_write_time(file, error).time_since_epoch().count()));
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, sizeof "2026-01-31T12:00:00Z"> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

/// Smallest load of other programs, as an average of the last minute, that is worth a warning.
constexpr double least_load = 0.25;

/// Asks OpenMP, because it ignores variables that it does not understand. Under OMP_PROC_BIND=master or
/// primary all threads share the place of the first one.
std::vector<std::vector<int>> places_of_threads() {
  const omp_proc_bind_t binding = omp_get_proc_bind();
  std::vector<std::vector<int>> places;
  for (int place = 0; binding != omp_proc_bind_false && place < omp_get_num_places(); ++place) {
    if (binding == omp_proc_bind_master && place != omp_get_place_num()) continue;
    places.emplace_back(static_cast<std::size_t>(omp_get_place_num_procs(place)));
    omp_get_place_proc_ids(place, places.back().data());
  }
  return places;
}

/// What is wrong with where OpenMP keeps the threads of a parallel run; empty if they stay on their CPUs.
std::string binding_noise(const Provenance& provenance) {
  if (provenance.thread_places.empty()) return "threads may move from CPU to CPU: set OMP_PROC_BIND=true";
  std::set<int> cpus;
  for (const std::vector<int>& place : provenance.thread_places) cpus.insert(place.begin(), place.end());
  const auto threads = static_cast<std::size_t>(provenance.threads);
  if (cpus.size() < std::min(threads, provenance.allowed_cpus.size()))
    return fmt::format("OMP_PROC_BIND, which is master or primary, keeps {} on {}: set OMP_PROC_BIND=true",
                       pluralize(threads, "thread"), pluralize(cpus.size(), "logical CPU"));
  // Moves within a core cost nothing.
  const std::size_t cpus_of_core = provenance.machine.smt.value_or(false) ? 2 : 1;
  const std::size_t largest = std::ranges::max(provenance.thread_places, {}, &std::vector<int>::size).size();
  if (largest > cpus_of_core)
    return fmt::format("threads may move among the {} of a place: set OMP_PLACES=threads",
                       pluralize(largest, "logical CPU"));
  return "";
}

}  // namespace

std::string_view cpu_generation(std::string_view maker, int family, int model) {
  const auto found = std::ranges::find_if(generations, [&](const Generation& generation) {
    return generation.maker == maker && generation.family == family && model >= generation.first_model &&
           model <= generation.last_model;
  });
  return found == std::end(generations) ? std::string_view() : found->name;
}

Machine read_machine(const fs::path& root) {
  const fs::path cpus = root / "sys/devices/system/cpu";
  Machine machine;
  machine.cpu_model = value_of(root / "proc/cpuinfo", "model name", ':');
  // On Arm the kernel gives numbers instead of a name.
  if (machine.cpu_model.empty())
    if (const std::string part = value_of(root / "proc/cpuinfo", "CPU part", ':'); !part.empty())
      machine.cpu_model = fmt::format("implementer {} part {}",
                                      value_of(root / "proc/cpuinfo", "CPU implementer", ':'), part);
  machine.cpu_generation = read_generation(root / "proc/cpuinfo");
  machine.logical_cpus = count_cpus(first_line(cpus / "online"));
  if (const std::string smt = first_line(cpus / "smt/active"); !smt.empty()) machine.smt = smt == "1";
  machine.numa_nodes = count_cpus(first_line(root / "sys/devices/system/node/online"));
  machine.cpu_mhz = leading_number<double>(value_of(root / "proc/cpuinfo", "cpu MHz", ':'));
  machine.caches = read_caches(cpus);
  if (std::string governor = first_line(cpus / "cpu0/cpufreq/scaling_governor"); !governor.empty())
    machine.governor = std::move(governor);
  machine.turbo = read_turbo(cpus);
  machine.load_average = read_load(root / "proc/loadavg");
  machine.memory_bytes = leading_number<std::uint64_t>(value_of(root / "proc/meminfo", "MemTotal", ':'))
                         << 10;
  const ContainerLimits limits = container_limits(root);
  machine.cpu_quota = limits.processors;
  machine.memory_limit_bytes = limits.memory_bytes;
  machine.operating_system = value_of(root / "etc/os-release", "PRETTY_NAME", '=');
  machine.kernel = kernel_name();
  return machine;
}

Provenance gather_provenance(const std::vector<std::string>& arguments, int threads) {
  Provenance provenance;
  provenance.build = build_info();
  provenance.program_fnv1a_64 = file_hash("/proc/self/exe");
  provenance.machine = read_machine();
  provenance.threads = threads;
  provenance.allowed_cpus = process_cpus();
  provenance.thread_environment = thread_environment();
  provenance.thread_places = places_of_threads();
  for (const std::string& argument : arguments)
    provenance.command_line.push_back(provenance.command_line.empty()
                                          ? escaped(std::filesystem::path(argument).filename().string())
                                          : escaped(without_home(argument)));
  provenance.noise = noise_of(provenance);
  provenance.started_utc = now_utc();
  return provenance;
}

void add_program(Provenance& provenance, BackendProgramRecord record, const std::filesystem::path& program,
                 const std::filesystem::path& folder) {
  // Larger arguments are data; reading them would take too long.
  constexpr std::uintmax_t largest_argument = std::uintmax_t{64} << 20;
  for (std::string& word : record.command) {
    const bool is_program = &word == &record.command.front();
    const std::filesystem::path file = is_program ? program : folder / word;
    const std::optional<std::uint64_t> hash = file_hash(file, is_program ? UINTMAX_MAX : largest_argument);
    word = escaped(without_home(word));
    if (hash) record.files.push_back({word, *hash});
  }
  for (auto& [name, value] : record.environment) value = escaped(without_home(value));
  std::ranges::sort(record.environment);
  const auto same_name = [](const FileHash& a, const FileHash& b) { return a.name == b.name; };
  std::ranges::sort(record.files, {}, &FileHash::name);
  record.files.erase(std::unique(record.files.begin(), record.files.end(), same_name), record.files.end());
  provenance.backend_programs.push_back(std::move(record));
  std::ranges::sort(provenance.backend_programs, {}, &BackendProgramRecord::name);
}

void add_scene(Provenance& provenance, std::string_view name, std::string_view file_text,
               std::optional<std::uint64_t> files_fnv1a_64) {
  provenance.scenes.push_back({std::string(name), fnv1a_64(file_text), files_fnv1a_64});
}

std::vector<std::string> noise_of(const Provenance& provenance) {
  const Machine& machine = provenance.machine;
  std::vector<std::string> noise;
  if (!machine.load_average.empty() && machine.load_average.front() >= least_load)
    noise.push_back(
        fmt::format("other programs are running (load {:.1f} over the last minute): end them or wait",
                    machine.load_average.front()));
  if (machine.governor && *machine.governor != "performance")
    noise.push_back("the frequency governor is \"" + *machine.governor +
                    "\": choose \"performance\" (cpupower frequency-set -g performance)");
  if (machine.turbo.value_or(false))
    noise.emplace_back("turbo is on, so the frequency depends on temperature and other cores: turn it off");
  const std::size_t cpus = provenance.allowed_cpus.size();
  if (provenance.threads > 1 && cpus > 0 && static_cast<std::size_t>(provenance.threads) > cpus)
    noise.push_back(fmt::format("{} threads share {}: give fewer with --threads", provenance.threads,
                                pluralize(cpus, "logical CPU")));
  if (machine.cpu_quota && provenance.threads > *machine.cpu_quota)
    noise.push_back(fmt::format(
        "this container's quota limits {} to the time of {:.1f} processors: {}",
        pluralize(provenance.threads, "thread"), *machine.cpu_quota,
        provenance.threads > 1 ? "give fewer with --threads, or raise the quota" : "raise the quota"));
  if (provenance.threads > 1)
    if (std::string moves = binding_noise(provenance); !moves.empty()) noise.push_back(std::move(moves));
  return noise;
}

}  // namespace mssim
