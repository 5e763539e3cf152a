#pragma once

#include <optional>

namespace mssim {

/// Bytes of a node in a message: position and velocity in single precision.
inline constexpr double message_node_bytes = 24;

/// How fast processes compute a cloth and send to each other: what the model of a step is made of.
struct ClusterRates {
  double node_stage_s = 0;      ///< of a process for a stage of a node
  double latency_s = 0;         ///< of a message of a few bytes
  double bytes_per_second = 0;  ///< that a process sends, while as much comes
  /// Whether its processor brings them across (shared memory, TCP on one machine): it cannot compute
  /// meanwhile. Else the network does, while the processor computes what waits for no message.
  bool processor_copies = false;
};

/// What a process does from one exchange with its neighbours to the next.
struct ExchangeWork {
  double node_stages = 0;        ///< computed, those twice that another process computes, too
  double inner_node_stages = 0;  ///< of these, those that wait for no message
  double bytes = 0;              ///< sent
  int rounds_of_messages = 0;    ///< of which one waits for the other
};

/// Seconds of that: what is computed, and latency + volume where the processor copies, else
/// max(0, latency + volume - inner).
double exchange_seconds(const ExchangeWork& work, const ClusterRates& rates);

/// A cloth, and an integrator of so many stages.
struct ClothStep {
  double rows = 0, columns = 0;
  int stages = 1;
};

/// How a cloth is cut, and how many steps there are between two exchanges.
struct ClothCut {
  int down = 1;    ///< parts of the rows
  int across = 1;  ///< parts of the columns
  int steps_an_exchange = 1;

  friend bool operator==(const ClothCut& a, const ClothCut& b) = default;
};

/// Nodes on each side that repeat a neighbour's: two for each stage of an exchange, as far as a spring goes.
double ghost_nodes(const ClothStep& step, const ClothCut& cut);

/// What the process with most to do does in an exchange: the one with most neighbours. None where a part
/// would be smaller than what its neighbours repeat of it.
std::optional<ExchangeWork> work_of(const ClothStep& step, const ClothCut& cut);

/// A cut, and the seconds that a step takes by the model.
struct CutTime {
  ClothCut cut;
  double step_s = 0;

  friend bool operator==(const CutTime& a, const CutTime& b) = default;
};

/// Stages between two exchanges at most, as openmp's walk has them (stages_under_way).
inline constexpr int most_stages_an_exchange = 4;

/// The fastest cut of the columns alone for so many processes, with 1, 2, 4, ... steps between two exchanges
/// and no more stages than these, or one step; none where the cloth cannot be cut so.
std::optional<CutTime> best_columns(const ClothStep& step, int processes, const ClusterRates& rates,
                                    int most_stages = most_stages_an_exchange);

/// The fastest cut of rows and columns, the same.
std::optional<CutTime> best_blocks(const ClothStep& step, int processes, const ClusterRates& rates,
                                   int most_stages = most_stages_an_exchange);

}  // namespace mssim
