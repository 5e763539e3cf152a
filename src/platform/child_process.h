#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mssim {

/// How a program that was run ended.
struct ChildResult {
  int exit_code = 0;           ///< what it returned, when signal is 0
  int signal = 0;              ///< what ended it, or 0
  bool out_of_time = false;    ///< it was ended because its processor time or its elapsed time was over
  bool out_of_memory = false;  ///< it failed when it had more than three quarters of memory_bytes
  std::string output;          ///< what it wrote to stdout and stderr, the last 64 KiB
};

/// How a program failed, for the end of a sentence: "ended with signal 6 when DOING: " and the first line of
/// its output that speaks of an error, or else the last one. Empty where it returned 0.
std::string failed_end(const ChildResult& result, const std::string& doing);

/// What a program is run with.
struct ChildProcess {
  std::filesystem::path program;
  std::vector<std::string> arguments;    ///< without the program's name
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's or replacing what it has
  std::filesystem::path folder;          ///< the folder it runs in
  unsigned cpu_seconds = 0;              ///< processor time after which the system ends it with SIGXCPU
  /// Time after which it is killed, with all that it started and all that runs together with it; 0: none.
  unsigned elapsed_seconds = 0;
  std::uint64_t memory_bytes = 0;  ///< the most address space that it gets; 0: as much as this process
  std::uint64_t file_bytes = 0;    ///< the longest file that it can write; 0: as long as this process can
};

/// Runs a program to its end: no shell, empty stdin, no core file. Throws std::runtime_error with one
/// sentence when it cannot be started, Interrupted (interruption.h) when this process was told to end
/// meanwhile: then the program and all that it started have been killed.
ChildResult run(const ChildProcess& child);

/// Runs several at the same time, until all have ended: their results, in the same order. Throws like the one
/// above; where one cannot be started, after the others have ended.
std::vector<ChildResult> run_together(std::span<const ChildProcess> children);

}  // namespace mssim
