#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "platform/process.h"

namespace mssim {

/// The energy that the packages of this machine's processors use, whoever uses them: Linux's counters of RAPL
/// (/sys/class/powercap), which are updated about every millisecond.
class PackageEnergy {
 public:
  /// `root` is prepended to /sys.
  explicit PackageEnergy(const std::filesystem::path& root = "/");
  /// Why there are no counters, a sentence with the remedy; empty if there are.
  const std::string& obstacle() const { return obstacle_; }
  /// J since the last call; nothing without counters, or if one can no longer be read.
  std::optional<double> joules();

 private:
  struct Counter {
    std::filesystem::path file;
    double range_uj;  ///< after which it starts again at 0
    double last_uj;
  };
  std::vector<Counter> counters_;
  std::string obstacle_;
};

/// An event that Linux counts: type and config of perf_event_open(2).
struct CountedEvent {
  std::uint32_t type = 0;
  std::uint64_t config = 0;
};

/// How often three events happen in user code of this process's threads, and of processes that they start
/// meanwhile. A thread has counters of its own, so what other programs do does not count.
class EventCounters {
 public:
  static constexpr std::size_t count = 3;
  using Events = std::array<CountedEvent, count>;
  /// Cycles, instructions, and cache misses: of the last cache on Intel, of the second on AMD's Zen.
  static const Events of_processor;

  explicit EventCounters(const Events& events = of_processor);
  /// Why the events cannot be counted, a sentence with the remedy; empty if they can.
  const std::string& obstacle() const { return obstacle_; }
  /// Counts from now on, in all threads that there are, and in those that they start.
  void start();
  /// Stops counting. The events since start(); if the processor has fewer counters than are in use, an
  /// estimate from the time for which it counted. Nothing if it did not count in a thread that ran, or if
  /// start() could not open a file for each thread and event.
  std::optional<std::array<double, count>> stop();

 private:
  /// Opens the counters of a thread (0: the calling one), switched off. Opens none if that fails, and returns
  /// errno; else 0.
  int open(int thread);

  Events events_;
  std::string obstacle_;
  std::vector<Descriptor> descriptors_;  ///< those of a thread follow each other
};

}  // namespace mssim
