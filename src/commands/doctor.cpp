#include "commands/doctor.h"

#include <unistd.h>

#include <algorithm>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>
#include <utility>

#include "application/bench/bench_plan.h"
#include "application/choices.h"
#include "application/prepared_scene.h"
#include "backends/backends.h"
#include "backends/devices/drivers.h"
#include "commands/command.h"
#include "commands/options.h"
#include "mesh/tetgen.h"
#include "output/tables/table.h"
#include "picture/picture.h"
#include "platform/counters.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "scene/fields/fields.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

using enum Checkup::State;

std::string_view name_of(Checkup::State state) {
  return state == ok ? "ok" : state == limited ? "limited" : "missing";
}

std::string gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.3g} GB", static_cast<double>(bytes) * 1e-9);
}

/// The finding that `look` completes; if it throws, the thing is missing, and the exception's sentence says
/// how to get it.
Checkup looked_at(std::string item, std::string use, const std::function<void(Checkup& finding)>& look) {
  Checkup finding{.item = std::move(item), .use = std::move(use)};
  try {
    look(finding);
  } catch (const std::exception& error) {
    finding.state = missing;
    finding.remedy = error.what();
  }
  return finding;
}

/// What noise_of() says about some of the facts: those that `choose` sets.
Checkup disturbance(std::string item, std::string found, std::string use,
                    const std::function<void(Provenance& chosen)>& choose) {
  Provenance chosen;
  choose(chosen);
  const std::string noise = join(noise_of(chosen), "; ");
  return {std::move(item), noise.empty() ? ok : limited, std::move(found), std::move(use), noise};
}

constexpr std::string_view main_scene = "cloth2500";

/// The first bench in README.md, without the backends that need a device.
BenchOptions main_job() {
  BenchOptions options;
  options.scenes = {std::string(main_scene)};
  options.backends = {std::string(baseline_backend().name), std::string(best_host_backend().name)};
  return options;
}

/// Takes a step of the main job with each of its combinations, and says so. Throws what mssim bench throws.
std::string tried_main_job() {
  BenchPlan plan = plan_of(main_job());
  PlannedScene& planned = plan.timed.front();
  const PreparedScene scene = planned.prepare();
  std::vector<std::string_view> names;
  for (const BackendInfo* backend : planned.backends) {
    for (const Integrator* integrator : plan.settings.integrators)
      make_backend(*backend, scene.system, *integrator, scene.dt_s, plan.settings.execution)->step(1);
    names.push_back(backend->name);
  }
  return fmt::format("{} steps on {}", scene.spec.name, listed(names));
}

Checkup threads_finding(int threads) {
  Checkup finding{
      "threads", ok, std::to_string(threads), "openmp, threads-mutex, and whatever runs in parallel", {}};
  if (const auto shortage = thread_shortage(threads)) {
    finding.state = limited;
    finding.remedy = *shortage;
  }
  return finding;
}

/// Compares with the scenes of Table 1, of which each is measured with all backends at once.
void look_at_memory(Checkup& finding) {
  BenchOptions options;
  options.suite = "table1";
  options.dry_run = true;
  finding.found = gigabytes(available_memory()) + " available";
  try {
    const BenchPlan plan = plan_of(options);
    const auto& largest = std::ranges::max(plan.timed, {}, &PlannedScene::memory_bytes);
    finding.found += fmt::format("; {} needs {}", largest.spec.name, gigabytes(largest.memory_bytes));
  } catch (const SceneError& shortage) {
    finding.state = limited;
    finding.remedy = shortage.what();
  }
}

void add_opencl(std::vector<Checkup>& findings) {
  const OpenclOffer& offer = opencl_offer();
  const std::string use = "backends opencl and hybrid";
  for (const OpenclDevice& device : offer.devices)
    findings.push_back({fmt::format("OpenCL device {}", device.number), offer.note.empty() ? ok : limited,
                        fmt::format("{} ({}), {} {}", device_name(device.name), name_of(device.type),
                                    device.platform, device.driver_version),
                        use, offer.note});
  for (const std::string& trouble : offer.troubles)
    findings.push_back({"OpenCL driver", limited, "", use, trouble});
  if (offer.devices.empty())
    findings.push_back(
        {"OpenCL device", missing, "none", use,
         "install Debian's package pocl-opencl-icd, which makes the processor one, or the driver "
         "of your GPU"});
}

void look_at_tetgen(Checkup& finding) {
  const auto tetgen = find_tetgen();
  if (!tetgen)
    throw MissingProgram("install Debian's package tetgen; meshes that are in the cache can be used");
  finding.found = fmt::format("{}, {}", escaped(tetgen->executable.string()), tetgen->version);
}

void look_at_mpi(Checkup& finding) {
  BackendChoice choice(table_backends(), {});
  const std::string reason = unavailable_reason(choice.require("mpi"), {});
  if (!reason.empty()) throw MissingProgram("{}", reason);
  const auto launcher = find_program("mpirun");
  if (!launcher)
    throw MissingProgram("mpirun is not in PATH; install Debian's package openmpi-bin, or give --launcher");
  finding.found = escaped(launcher->string());
  if (::geteuid() != 0 ||
      (variable("OMPI_ALLOW_RUN_AS_ROOT") == "1" && variable("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM") == "1"))
    return;
  ChildProcess asked;
  asked.program = *launcher;
  asked.arguments = {"--version"};
  asked.folder = ".";
  asked.elapsed_seconds = 10;
  const ChildResult version = run(asked);
  if (version.output.find("Open MPI") == std::string::npos) return;
  finding.state = limited;
  finding.remedy =
      "Open MPI starts nothing as root: set OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1";
}

/// A cache that cannot be written costs only time. Makes its folder, as a bench would: only writing shows
/// whether that is possible.
Checkup cache_finding(const std::string& name, std::string use) {
  const std::filesystem::path folder = cache_folder(name);
  Checkup finding{"cache of " + name,
                  ok,
                  folder.empty() ? "no home folder" : escaped(folder.string()),
                  std::move(use),
                  {}};
  try {
    const TemporaryFolder trial(make_folder(folder));
  } catch (const WriteError&) {
    finding.state = limited;
    finding.remedy =
        "it cannot be written, so each run starts anew: set XDG_CACHE_HOME to a folder that can be";
  }
  return finding;
}

std::vector<Checkup> findings_here() {
  const int threads = complete({}).threads;
  std::vector<Checkup> findings = machine_findings(gather_provenance({}, threads));
  findings.insert(findings.begin() + 1, threads_finding(threads));
  findings.push_back(looked_at("memory", "all scenes of --suite table1", look_at_memory));
  const auto add_counters = [&](const char* item, const char* use, const std::string& obstacle) {
    findings.push_back({item, obstacle.empty() ? ok : limited, "", use, obstacle});
  };
  add_counters("energy counters", "the column joules_per_step of mssim bench", PackageEnergy().obstacle());
  add_counters("event counters", "the columns cycles_per_step to cache_misses_per_step of mssim bench",
               EventCounters().obstacle());
  add_opencl(findings);
  findings.push_back(looked_at("TetGen", "meshes of bodies: --suite table2 and table3", look_at_tetgen));
  findings.push_back(looked_at("MPI", "backend mpi: several processes or machines", look_at_mpi));
  findings.push_back(looked_at("temporary folder",
                               "meshes of bodies, backends that are programs, pictures of scenes",
                               [](Checkup& finding) {
                                 finding.found = escaped(variable("TMPDIR", "/tmp"));
                                 const TemporaryFolder trial;
                               }));
  findings.push_back(looked_at("font", "letters on pictures of mssim render", [](Checkup& finding) {
    require_font();
    finding.found = "DejaVu Sans";
  }));
  findings.push_back(cache_finding("meshes", "bodies, each of which TetGen meshes only once"));
  findings.push_back(
      cache_finding("references", "verification, whose long references are computed only once"));
  return findings;
}

/// Lines of at most `width` characters: state and item on the left, the rest on the right.
std::string text_of(const std::vector<Checkup>& findings, std::size_t width) {
  std::string text;
  for (const Checkup& finding : findings) {
    std::string left = fmt::format("{:<9}{:<21}", name_of(finding.state), finding.item);
    for (const std::string& part : {finding.found, "for " + finding.use, finding.remedy}) {
      std::istringstream lines(wrapped(part, width - left.size(), ""));
      for (std::string line; std::getline(lines, line); left.assign(left.size(), ' '))
        text += left + line + '\n';
    }
  }
  return text;
}

Table table_of(const std::vector<Checkup>& findings) {
  Table table;
  const auto cell = [](const std::string& text) { return text.empty() ? Cell() : Cell(text); };
  for (const Checkup& finding : findings)
    table.add({{"item", finding.item},
               {"state", name_of(finding.state)},
               {"found", cell(finding.found)},
               {"use", finding.use},
               {"remedy", cell(finding.remedy)}});
  return table;
}

int run(ListingFormat format) {
  int code = exit_ok;
  std::vector<Checkup> findings{
      looked_at("main job", fmt::format("mssim bench --scene {}", main_scene), [&](Checkup& finding) {
        try {
          finding.found = tried_main_job();
        } catch (const Error& error) {
          code = error.exit_code;
          throw;
        } catch (...) {
          code = exit_file_error;
          throw;
        }
      })};
  std::ranges::move(findings_here(), std::back_inserter(findings));
  constexpr int usual_width = 80, least_width = 50;
  const int width = std::max(terminal_of(STDOUT_FILENO).width.value_or(usual_width), least_width);
  std::cout << (format == ListingFormat::table ? text_of(findings, static_cast<std::size_t>(width))
                                               : to_text(table_of(findings), format));
  return code;
}

std::string text_of(const Cache& cache) {
  const std::uint64_t kib = cache.bytes >> 10;
  const std::string size =
      kib < 1024 ? fmt::format("{} KiB", kib) : fmt::format("{:.3g} MiB", static_cast<double>(kib) / 1024);
  return fmt::format("{} x L{} of {}", cache.count, cache.level, size);
}

}  // namespace

std::vector<Checkup> machine_findings(const Provenance& provenance) {
  const Machine& machine = provenance.machine;
  const std::size_t allowed = provenance.allowed_cpus.size();
  const auto cpus = static_cast<std::size_t>(machine.logical_cpus);
  std::vector<std::string> caches;
  for (const Cache& cache : machine.caches)
    if (cache.type != "Instruction") caches.push_back(text_of(cache));
  std::vector<Checkup> findings{
      {"processor", ok, fmt::format("{}; {}", cpu_name(machine), pluralize(cpus, "logical CPU")),
       "all measured times", ""},
      {"processor caches", caches.empty() ? limited : ok,
       caches.empty() ? "not reported" : join(caches, ", "), "the choice of steps per pass over memory", ""}};

  Checkup affinity = disturbance("affinity", fmt::format("{} of {}", allowed, pluralize(cpus, "logical CPU")),
                                 "threads that stay on their CPUs", [&](Provenance& chosen) {
                                   chosen.threads = provenance.threads;
                                   chosen.allowed_cpus = provenance.allowed_cpus;
                                   chosen.thread_places = provenance.thread_places;
                                   chosen.machine.smt = machine.smt;
                                 });
  if (allowed < cpus) {
    affinity.state = limited;
    append_sentence(affinity.remedy,
                    "start mssim without taskset, or with more CPUs from the container or the job");
  }
  findings.push_back(affinity);

  Checkup container{"container limits", ok, "none", "as many CPUs and as much memory as the machine has", ""};
  std::vector<std::string> limits;
  if (machine.cpu_quota) limits.push_back(fmt::format("the time of {:.3g} processors", *machine.cpu_quota));
  if (machine.memory_limit_bytes) limits.push_back(gigabytes(*machine.memory_limit_bytes));
  if (!limits.empty())
    container = {container.item, limited, listed(limits), container.use,
                 "raise the limits of the container, the job or the unit (docker run --cpus --memory)"};
  findings.push_back(container);

  findings.push_back(disturbance("governor",
                                 machine.governor.value_or("not reported, as in most virtual machines"),
                                 "one frequency in all samples", [&](Provenance& chosen) {
                                   chosen.machine.governor = machine.governor;
                                   chosen.machine.turbo = machine.turbo;
                                 }));
  const std::vector<double>& load = machine.load_average;
  findings.push_back(disturbance(
      "load", load.empty() ? "not reported" : fmt::format("{:.1f} over the last minute", load.front()),
      "narrow intervals of times", [&](Provenance& chosen) { chosen.machine.load_average = load; }));
  return findings;
}

std::function<int()> declare_doctor(Arguments& arguments) {
  const auto format = std::make_shared<ListingFormat>(ListingFormat::table);
  declare_listing_format(arguments, *format);
  return [format] { return run(*format); };
}

}  // namespace mssim
