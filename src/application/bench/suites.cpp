#include "application/bench/suites.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "application/choices.h"
#include "application/guide_run.h"
#include "backends/accumulation/accumulation_methods.h"
#include "garment/output/garment_tables.h"
#include "integrators/all_integrators.h"
#include "platform/machine.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr std::array<std::string_view, 6> cloths{"cloth2500", "cloth4900", "cloth10k",
                                                 "cloth40k",  "cloth200k", "cloth350k"};
constexpr std::array<std::string_view, 9> single_bodies{"box-small",    "box-medium",    "box-large",
                                                        "sphere-small", "sphere-medium", "sphere-large",
                                                        "torus-small",  "torus-medium",  "torus-large"};
constexpr std::array<std::string_view, 6> body_scenes{"bodies3858",  "bodies4737",  "bodies7282",
                                                      "bodies10223", "bodies20587", "bodies38233"};
constexpr std::array<std::string_view, 2> race_scenes{"cloth40k", "bodies20587"};
constexpr std::array<std::string_view, 6> ever_larger_cloths{"cloth40k", "cloth200k", "cloth350k",
                                                             "cloth1m",  "cloth4m",   "cloth16m"};
constexpr std::array<std::string_view, 4> scenes_of_peers{"cloth2500", "cloth40k", "cloth350k",
                                                          "bodies38233"};
constexpr std::array<std::string_view, 6> jeans{"jeans1k", "jeans2k",  "jeans4k",
                                                "jeans8k", "jeans16k", "jeans64k"};

/// The scenes of `--suite cluster`: cloths and bodies of fixed size (strong scaling), and cloths NAME-xN that
/// are N times as wide for N processes (weak scaling).
constexpr std::array<std::string_view, 10> cluster_scenes{
    "cloth350k",   "cloth350k-x2", "cloth350k-x4", "cloth350k-x8", "cloth10k",
    "cloth10k-x2", "cloth10k-x4",  "cloth10k-x8",  "cloth4m",      "bodies38233"};

/// Hong et al.'s cloths and bodies. Vassilev's panels have the structure of the cloths.
constexpr auto scenes_of_guide = [] {
  std::array<std::string_view, cloths.size() + body_scenes.size()> all{};
  std::ranges::copy(body_scenes, std::ranges::copy(cloths, all.begin()).out);
  return all;
}();

/// Figure 5 of Hong et al. is for ten threads.
constexpr std::array<std::string_view, 1> cloths_as_published{"threads-mutex:10"};
/// Hong et al. step one object after the other (Conclusions).
constexpr std::array<std::string_view, 7> bodies_as_published{
    "serial:each", "threads-mutex:10", "threads-mutex:each", "threads-mutex:each:10",
    "openmp:each", "opencl:each",      "hybrid:each"};

constexpr std::array<std::string_view, 1> cheapest_method{"semi-euler"};

std::vector<const BackendInfo*> all_methods() {
  return mapped<const BackendInfo*>(accumulation_methods(),
                                    [](const AccumulationMethod& method) { return &method.backend; });
}

/// All backends, including those that cannot dress, whose rows give that reason.
std::vector<const BackendInfo*> all_that_dress() { return with_garment_backends(table_backends()); }

/// Algorithm 1 as printed is not measured on the finest jeans, which take many minutes.
bool is_dressed_soon(std::string_view scene, std::string_view backend) {
  return scene != jeans.back() ||
         std::ranges::find(garment_backends(), backend, &BackendInfo::name) == garment_backends().end();
}

/// The backends with which peers and ranks are compared: the plain list and the fastest on the host.
std::vector<const BackendInfo*> baseline_and_best() { return {&baseline_backend(), &best_host_backend()}; }

/// 1, 2, 4, ... and the largest.
std::vector<int> rank_counts(const ExecutionOptions& execution) {
  constexpr int fewest = 4;
  const auto processors = static_cast<int>(process_cpus().size());
  const int threads = execution.threads_given ? execution.threads : 1;
  const int most = execution.ranks > 0 ? execution.ranks : std::max(fewest, processors / threads);
  std::vector<int> counts;
  for (int ranks = 1; ranks < most; ranks *= 2) counts.push_back(ranks);
  counts.push_back(most);
  return counts;
}

/// mpi in 1, 2, 4, ... processes up to --ranks, or by default up to the number of CPUs over --threads and at
/// least four; and equally many copies that do not communicate.
std::vector<std::string> cluster_programs(const ExecutionOptions& execution) {
  std::vector<std::string> names;
  for (const int ranks : rank_counts(execution)) names.push_back(name_in_ranks(ranks_backend, ranks));
  for (const int ranks : rank_counts(execution))
    if (ranks > 1) names.push_back(name_in_ranks(copies_backend, ranks));
  return names;
}

/// A cloth N times as wide is measured only in N processes.
bool is_in_cluster(std::string_view scene, std::string_view backend) {
  const WideScene wide = wide_scene(scene);
  return wide.times == 1 || backend == name_in_ranks(ranks_backend, wide.times);
}

/// No tables, for the suite of the guide, which makes its own.
TableMaker no_tables() {
  return [](const auto&...) { return std::vector<ResultTable>(); };
}

TableMaker tables_of_hong() { return paper_tables(paper_legend(), published_tables()); }

/// Tables of both papers: each paper's scenes have their own.
TableMaker tables_of_the_papers() {
  return [hong = tables_of_hong(), vassilev = garment_tables()](std::span<const ResultRow> rows,
                                                                const Provenance& provenance) {
    std::vector<ResultTable> tables = hong(rows, provenance);
    std::ranges::move(vassilev(rows, provenance), std::back_inserter(tables));
    return tables;
  };
}

TableMaker table_of_races() {
  std::vector<RaceLegend> legend;
  for (const AccumulationMethod& method : accumulation_methods())
    legend.push_back({std::string(method.backend.name), std::string(method.backend.description),
                      std::string(method.extra_memory), std::string(method.springs_computed),
                      std::string(name_of(method.repeatable))});
  return race_tables(std::move(legend));
}

TableMaker table_of_cluster() {
  StageCounts stages;
  for (const Integrator* integrator : all_integrators)
    stages.emplace(integrator->name, static_cast<int>(integrator->stage_count));
  return cluster_tables(std::move(stages));
}

TableMaker table_of_scaling() { return scaling_tables(std::string(ever_larger_cloths.front())); }

constexpr Comparison of_backends{table_backends, paper_integrators, tables_of_the_papers};
constexpr Comparison of_methods{all_methods, cheapest_method, table_of_races};
constexpr Comparison of_sizes{table_backends, cheapest_method, table_of_scaling};
constexpr Comparison of_peers{baseline_and_best, cheapest_method, peer_tables, true};
constexpr Comparison of_ranks{
    baseline_and_best, cheapest_method, table_of_cluster, false, cluster_programs, is_in_cluster, 1};
constexpr Comparison of_dressings{all_that_dress, cheapest_method, garment_tables,
                                  false,          nullptr,         is_dressed_soon};
constexpr Comparison of_guides{guide_backends, guide_integrators, no_tables};

constexpr auto table = std::to_array<Suite>({
    {"table1", "times of cloths: Table 1 of Hong et al.", true, true, cloths, of_backends,
     cloths_as_published},
    {"table2", "sizes of single bodies: Table 2 of Hong et al.", true, false, single_bodies, of_backends},
    {"table3", "times of several bodies: Table 3 of Hong et al.", true, true, body_scenes, of_backends,
     bodies_as_published},
    {"races", "the cost of each method to avoid the data race of springs (mssim list methods)", false, true,
     race_scenes, of_methods},
    {"scaling", "the time per node in cloths of up to 16 million nodes", false, true, ever_larger_cloths,
     of_sizes},
    {"peers", "comparison with the same scenes in other languages and libraries (scripts/peers)", false, true,
     scenes_of_peers, of_peers},
    {"cluster",
     "several processes on one or more machines: the cost of messages, and estimates for larger clusters",
     false, true, cluster_scenes, of_ranks},
    {"garment", "jeans on a body, dressing and draped: Figure 6 of Vassilev", false, true, jeans,
     of_dressings},
    {guide_suite,
     "recommended integrator, backend and step for each cloth and body, as mssim guide finds them", false,
     true, scenes_of_guide, of_guides},
});

bool belongs(const Suite& suite, std::string_view name) {
  return name == suite.name || (name == "tables" && suite.in_tables);
}

}  // namespace

PaperLegend paper_legend() {
  PaperLegend legend;
  std::set<std::string_view> variants;
  for (const Suite& suite : table) variants.insert(suite.variants.begin(), suite.variants.end());
  for (const BackendInfo* backend : with_garment_backends(table_backends())) {
    const auto add = [&](std::string_view name) {
      legend.backends.push_back(
          {std::string(name), std::string(backend->paper_configuration), backend->makes_threads});
    };
    add(backend->name);
    for (const std::string_view variant : variants)
      if (is_variant(variant, backend->name)) add(variant);
  }
  for (const BrowserBackend& backend : browser_backends)
    legend.backends.push_back({std::string(backend.name), std::string(backend.paper_configuration)});
  for (const Integrator* integrator : all_integrators)
    legend.integrators.push_back({std::string(integrator->name), std::string(integrator->paper_name),
                                  static_cast<int>(integrator->stage_count)});
  return legend;
}

std::span<const Suite> suites() { return table; }

std::vector<std::string> scenes_of_suite(std::string_view name, bool timed) {
  std::vector<std::string> scenes;
  for (const Suite& suite : table)
    if (suite.timed == timed && belongs(suite, name))
      scenes.insert(scenes.end(), suite.scenes.begin(), suite.scenes.end());
  return scenes;
}

std::vector<std::string_view> variants_of_suite(std::string_view name, std::string_view scene) {
  std::vector<std::string_view> variants;
  for (const Suite& suite : table)
    if (belongs(suite, name) && std::ranges::find(suite.scenes, scene) != suite.scenes.end())
      for (const std::string_view variant : suite.variants) add_once(variants, variant);
  return variants;
}

const Comparison& comparison_of_suite(std::string_view name) {
  const auto suite = std::ranges::find(table, name, &Suite::name);
  return suite == table.end() ? of_backends : suite->comparison;
}

}  // namespace mssim
