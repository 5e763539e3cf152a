#include "output/tables/cluster_estimates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

/// A network as clusters have them: what is usual, not what any one of them does.
struct Network {
  std::string_view name;
  double latency_s = 0;
  double bytes_per_second = 0;
};
constexpr std::array<Network, 2> networks{
    {{"InfiniBand 100 Gbit/s", 1.5e-6, 11e9}, {"Ethernet 10 Gbit/s", 25e-6, 1.1e9}}};
constexpr std::array<double, 3> cloth_sides{1e4, 31'623, 1e5};  ///< of about 10^8, 10^9 and 10^10 nodes
constexpr std::array<int, 7> machine_counts{10, 30, 100, 300, 1000, 3000, 10'000};

/// Processors of a machine of a cluster; more where more were measured.
constexpr int usual_processors = 64;

struct Estimate {
  const Network* network = nullptr;
  double side = 0;
  int machines = 0;
  double perfect_s = 0;  ///< of a step without messages
  std::optional<CutTime> columns = {};
  std::optional<CutTime> blocks = {};
  std::optional<CutTime> shallow = {};  ///< the better one of both with an exchange every step
};

ClusterRates rates_of(const ClusterRows::MachineRate& machine, const Network& network) {
  return {machine.node_stage_s, network.latency_s, network.bytes_per_second, false};
}

std::optional<CutTime> better(const std::optional<CutTime>& a, const std::optional<CutTime>& b) {
  if (!a || !b) return a ? a : b;
  return a->step_s <= b->step_s ? a : b;
}

Estimate estimate(const ClusterRows::MachineRate& machine, const Network& network, double side, int machines,
                  int stages) {
  const ClothStep cloth{side, side, stages};
  const ClusterRates rates = rates_of(machine, network);
  Estimate estimate{&network, side, machines, side * side * stages * machine.node_stage_s / machines};
  estimate.columns = best_columns(cloth, machines, rates);
  estimate.blocks = best_blocks(cloth, machines, rates);
  estimate.shallow = better(best_columns(cloth, machines, rates, 1), best_blocks(cloth, machines, rates, 1));
  return estimate;
}

std::vector<Estimate> estimates_of(const ClusterRows::MachineRate& machine, int stages) {
  std::vector<Estimate> all;
  for (const Network& network : networks)
    for (const double side : cloth_sides)
      for (const int machines : machine_counts)
        all.push_back(estimate(machine, network, side, machines, stages));
  return all;
}

/// A text that is shown as 10^8.
std::string power_of_ten(double nodes) { return "10^" + std::to_string(std::lround(std::log10(nodes))); }

Cell efficiency_cell(const Estimate& estimate, const std::optional<CutTime>& cut) {
  return cut ? Cell(estimate.perfect_s / cut->step_s) : Cell();
}

Table data_of(const std::vector<Estimate>& estimates) {
  Table table;
  for (const Estimate& estimate : estimates) {
    const auto ms = [](const std::optional<CutTime>& cut) { return cut ? Cell(1000 * cut->step_s) : Cell(); };
    const auto part = [](const std::optional<CutTime>& cut, int ClothCut::*member) {
      return cut ? Cell(cut->cut.*member) : Cell();
    };
    table.add({{"network", estimate.network->name},
               {"latency_us", 1e6 * estimate.network->latency_s},
               {"gigabytes_per_second", 1e-9 * estimate.network->bytes_per_second},
               {"rows", std::lround(estimate.side)},
               {"columns", std::lround(estimate.side)},
               {"machines", estimate.machines},
               {"estimated_ms_one_step_an_exchange", ms(estimate.shallow)},
               {"estimated_ms_columns", ms(estimate.columns)},
               {"steps_an_exchange_columns", part(estimate.columns, &ClothCut::steps_an_exchange)},
               {"estimated_efficiency_columns", efficiency_cell(estimate, estimate.columns)},
               {"estimated_ms_blocks", ms(estimate.blocks)},
               {"blocks_down", part(estimate.blocks, &ClothCut::down)},
               {"blocks_across", part(estimate.blocks, &ClothCut::across)},
               {"steps_an_exchange_blocks", part(estimate.blocks, &ClothCut::steps_an_exchange)},
               {"estimated_efficiency_blocks", efficiency_cell(estimate, estimate.blocks)}});
  }
  return table;
}

/// A difference that pays.
constexpr double clearly_faster = 0.98;

bool halos_pay(const Estimate& estimate) {
  const std::optional<CutTime> best = better(estimate.columns, estimate.blocks);
  return best && best->step_s < clearly_faster * estimate.shallow->step_s;
}

bool blocks_pay(const Estimate& estimate) {
  return estimate.blocks &&
         (!estimate.columns || estimate.blocks->step_s < clearly_faster * estimate.columns->step_s);
}

/// "from 300 machines on", for the estimates of a network and a cloth.
template <class Pays>
std::string where(const std::vector<Estimate>& estimates, const Network& network, double side,
                  const Pays& pays) {
  for (const Estimate& estimate : estimates)
    if (estimate.network == &network && estimate.side == side && pays(estimate))
      return "from " + grouped(static_cast<std::uint64_t>(estimate.machines)) + " machines on";
  return "nowhere up to " + grouped(machine_counts.back());
}

Cell percent(const Estimate& estimate, const std::optional<CutTime>& cut) {
  return cut ? Cell(three_digits(100 * estimate.perfect_s / cut->step_s)) : Cell("-");
}

Table table_of(const std::vector<Estimate>& estimates, const Network& network) {
  Table table{{{"nodes"},
               {"machines", Align::right},
               {"columns, ms, estimated", Align::right},
               {"steps an exchange", Align::right},
               {"efficiency", Align::right, " %"},
               {"blocks, ms, estimated", Align::right},
               {"cut", Align::right},
               {"steps an exchange", Align::right},
               {"efficiency", Align::right, " %"}},
              {}};
  for (const Estimate& estimate : estimates) {
    if (estimate.network != &network) continue;
    const auto ms = [](const std::optional<CutTime>& cut) {
      return cut ? Cell(three_digits(1000 * cut->step_s)) : Cell("-");
    };
    const auto steps = [](const std::optional<CutTime>& cut) {
      return cut ? Cell(cut->cut.steps_an_exchange) : Cell("-");
    };
    const std::string cut = estimate.blocks ? std::to_string(estimate.blocks->cut.down) + " x " +
                                                  std::to_string(estimate.blocks->cut.across)
                                            : "-";
    table.rows.push_back({power_of_ten(estimate.side * estimate.side),
                          grouped(static_cast<std::uint64_t>(estimate.machines)), ms(estimate.columns),
                          steps(estimate.columns), percent(estimate, estimate.columns), ms(estimate.blocks),
                          cut, steps(estimate.blocks), percent(estimate, estimate.blocks)});
  }
  return table;
}

}  // namespace

ResultTable cluster_estimates(const ClusterRows& rows, const ClusterRows::MachineRate& measured,
                              const Provenance& provenance) {
  const int stages = rows.stages_of(*measured.row);
  const int processors = std::max(usual_processors, measured.row->threads);
  ClusterRows::MachineRate machine = measured;
  machine.node_stage_s *= static_cast<double>(measured.row->threads) / processors;
  const std::vector<Estimate> estimates = estimates_of(machine, stages);
  Document page{
      Heading{1, "Estimated: many machines, larger cloths"},
      Paragraph{"Nothing on this page was measured but the speed of one machine: " + made_by(provenance) +
                ". Its " + pluralize(static_cast<std::uint64_t>(measured.row->threads), "processor") +
                " together took " + three_digits(1e9 * measured.node_stage_s * stages) +
                " ns a node and step of `" + measured.row->integrator + "` (`" + measured.row->backend +
                "`, `" + measured.row->scene + "`). A machine of this page has " +
                std::to_string(processors) +
                " processors, each as fast, and sends to its neighbours as such a network usually does. The "
                "model is that of cluster.md, which holds it against measured times. *Columns*: each machine "
                "has some columns of the cloth, as `mpi` does. *Blocks*: some rows and columns. Both with as "
                "many steps between two exchanges, up to four stages, as take the least time. *Efficiency*: "
                "against a step without messages. A line - is where a part would be narrower than what its "
                "neighbours repeat of it."}};
  for (const Network& network : networks) {
    BulletList list;
    for (const double side : cloth_sides)
      list.items.push_back(power_of_ten(side * side) + " nodes: several steps an exchange pay " +
                           where(estimates, network, side, halos_pay) + ", blocks of rows and columns " +
                           where(estimates, network, side, blocks_pay));
    page.insert(page.end(),
                {Heading{2, std::string(network.name) + ": " + three_digits(1e6 * network.latency_s) +
                                " µs, " + three_digits(1e-9 * network.bytes_per_second) + " GB/s"},
                 table_of(estimates, network), std::move(list)});
  }
  return {"cluster-estimates", data_of(estimates), std::move(page)};
}

}  // namespace mssim
