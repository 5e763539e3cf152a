#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

/// A program that is a backend: it speaks the protocol of docs/own-backends.md.
struct BackendProgram {
  std::string name;                      ///< of its rows
  std::string description;               ///< one line for `mssim list backends`
  std::vector<std::string> command;      ///< as its user wrote it: the program, and its arguments
  std::filesystem::path program;         ///< the file that is run; empty where it is missing
  std::vector<std::string> environment;  ///< NAME=VALUE, added to this process's
  std::filesystem::path folder;          ///< the one it runs in
  std::string missing;                   ///< why it cannot be run; empty where it can be
  bool steps_cloths = true;
  bool steps_bodies = true;
  std::vector<std::string> integrators;  ///< those that it has; empty: all explicit ones
  double time_limit_s = 120;             ///< of every answer
  /// It runs in several processes (--ranks), and builds its parts of a cloth from the scene's file.
  bool in_ranks = false;
  int ranks = 0;  ///< processes that its name asks for, as mpi:4 does; 0: --ranks
  /// It knows the requests `restart` and `get ROW COLUMN ROWS COLUMNS` of docs/own-backends.md; in ranks
  /// alone.
  bool has_windows = false;
};

/// Longest time limit, s.
inline constexpr double longest_time_limit_s = 86400;

}  // namespace mssim
