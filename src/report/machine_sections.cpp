#include <algorithm>

#include "report/html.h"
#include "report/sections.h"
#include "text/text.h"

namespace mssim {
namespace {

/// In gibibytes.
std::string memory_of(const Machine& machine) {
  return three_digits(static_cast<double>(machine.memory_bytes) / (1U << 30U)) + " GiB";
}

std::string caches_of(const Machine& machine) {
  std::vector<std::string> caches;
  for (const Cache& cache : machine.caches)
    caches.push_back("L" + std::to_string(cache.level) + " " + cache.type + " " +
                     std::to_string(cache.count) + " × " + grouped(cache.bytes / 1024) + " KiB");
  return join(caches, ", ");
}

std::string rounds_of(const ReportFolder& folder) {
  int least = 0, most = 0;
  for (const ResultRow& row : folder.rows)
    if (row.rounds > 0) {
      least = least == 0 ? row.rounds : std::min(least, row.rounds);
      most = std::max(most, row.rounds);
    }
  return least == most ? std::to_string(most) : std::to_string(least) + " to " + std::to_string(most);
}

std::vector<Table::NamedCell> facts_of(const ReportFolder& folder) {
  const Provenance& provenance = *folder.provenance;
  const Machine& machine = provenance.machine;
  return {{"processor", cpu_name(machine)},
          {"logical CPUs", machine.logical_cpus},
          {"threads", provenance.threads},
          {"memory", memory_of(machine)},
          {"OpenCL devices", join(provenance.opencl_devices, "; ")},
          {"system", machine.operating_system},
          {"compiler", provenance.build.compiler + ", " + provenance.build.build_type},
          {"mssim", made_by(provenance)},
          {"rounds", rounds_of(folder)}};
}

std::string provenance_of(const ReportFolder& folder) {
  const Provenance& provenance = *folder.provenance;
  const Machine& machine = provenance.machine;
  std::vector<std::string> environment, scenes, load;
  for (const auto& [name, value] : provenance.thread_environment) environment.push_back(name + "=" + value);
  for (const SceneHash& scene : provenance.scenes)
    scenes.push_back(scene.name + " " + to_hex(scene.fnv1a_64));
  for (const double average : machine.load_average) load.push_back(fixed_decimal(average, 2));
  const auto or_nothing = [](const std::string& text) { return text.empty() ? Cell() : Cell(text); };
  Table table{{{"what"}, {"value"}}, {}};
  const auto line = [&](const char* what, Cell value) { table.rows.push_back({what, std::move(value)}); };
  line("command", join(provenance.command_line, " "));
  line("started", provenance.started_utc);
  line("continues runs of", or_nothing(join(provenance.earlier_starts_utc, ", ")));
  line("commit", provenance.build.commit + (provenance.build.dirty ? ", with uncommitted changes" : ""));
  line("program", provenance.program_fnv1a_64 ? Cell(to_hex(*provenance.program_fnv1a_64)) : Cell());
  line("compiler flags", provenance.build.flags);
  line("caches", or_nothing(caches_of(machine)));
  line("frequency", three_digits(machine.cpu_mhz / 1000) + " GHz");
  line("governor", machine.governor ? Cell(*machine.governor) : Cell());
  line("turbo", machine.turbo ? Cell(*machine.turbo) : Cell());
  line("kernel", machine.kernel);
  line("load average", or_nothing(join(load, ", ")));
  line("environment of threads", or_nothing(join(environment, ", ")));
  line("memory of devices", or_nothing(provenance.device_memory));
  line("TetGen", or_nothing(provenance.tetgen));
  line("hashes of scenes", or_nothing(join(scenes, ", ")));
  Document page{Paragraph{"Sources of noise that mssim saw when it started:"}, BulletList{provenance.noise}};
  if (provenance.noise.empty()) page = {Paragraph{"mssim saw no source of noise when it started."}};
  page.emplace_back(std::move(table));
  return html_of(page, 4);
}

}  // namespace

std::string id_of(std::size_t folder) { return "f" + std::to_string(folder + 1); }

std::string folder_heading(const ReportInput& input, const ReportFolder& folder) {
  return input.folders.size() < 2 ? std::string() : "<h3>" + html_text(folder.name) + "</h3>\n";
}

std::string machine_section(const ReportInput& input) {
  Table table;
  BulletList problems{input.problems};
  for (const ReportFolder& folder : input.folders) {
    problems.items.insert(problems.items.end(), folder.problems.begin(), folder.problems.end());
    if (!folder.provenance) continue;
    const auto facts = facts_of(folder);
    if (table.columns.empty()) {
      table.columns.push_back({"folder"});
      for (const Table::NamedCell& fact : facts)
        table.columns.push_back({std::string(fact.column), Align::left});
    }
    std::vector<Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(folder.name);
    for (const Table::NamedCell& fact : facts) cells.push_back(fact.cell);
  }
  std::string text =
      table.rows.empty() ? "<p>No folder says on which machine it was measured.</p>\n" : html_of(table);
  // These name files, in which no mark is meant.
  if (!problems.items.empty()) {
    text += "<h3>What is missing or damaged</h3>\n<ul class=\"problems\">\n";
    for (const std::string& problem : problems.items) text += "<li>" + html_text(problem) + ".</li>\n";
    text += "</ul>\n";
  }
  return text;
}

std::string provenance_section(const ReportInput& input) {
  std::string text;
  for (const ReportFolder& folder : input.folders)
    text += folder_heading(input, folder) +
            (folder.provenance ? provenance_of(folder)
                               : "<p>provenance.json is missing or damaged: where these numbers come from is "
                                 "not known.</p>\n");
  return text;
}

}  // namespace mssim
