#pragma once

#include <cstdlib>
#include <map>
#include <ostream>
#include <string>
#include <string_view>

#include "platform/process.h"

namespace mssim {

/// A variable of the environment, or what stands for it where it is not set or empty.
inline std::string variable(const char* name, const char* otherwise = "") {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

// What the process that starts the launcher (launch_ranks) and the ranks say to each other: the ranks among
// all that they print.

/// The argument of mssim-mpi, and of its ranks, by which each steps the whole scene.
inline constexpr std::string_view copies_word = "copies";

/// On stdout, once: MPI has started, on all hosts.
inline constexpr std::string_view ranks_have_started = "mssim-mpi: all ranks have started";

/// On stderr, before the sentence with which a rank fails.
inline constexpr std::string_view sentence_mark = "mssim-mpi: ";

/// What mssim starts: runs the launcher of MPI (MSSIM_LAUNCHER, default `mpirun`) with MSSIM_RANKS times
/// `mssim-mpi rank`, or `mssim-mpi rank copies`, passes on what they print, and waits for its end. Where they
/// fail, the last line on stderr is the sentence that says why. Returns the exit code.
int launch_ranks(bool copies);

/// What a launcher of MPI starts as many times as there are ranks (`mssim-mpi rank`): steps a part of the
/// scene, or (`mssim-mpi rank copies`) the whole; rank 0 speaks with mssim. Returns the exit code. Where a
/// rank fails, its sentence is on stderr, and all ranks are ended.
int run_rank(int argc, char** argv);

/// The program's end of the protocol of own backends (docs/protocol.md): what mssim says comes line by
/// line.
class Requests {
 public:
  /// Connects to the socket that MSSIM_SOCKET names. Throws std::runtime_error with one sentence.
  Requests();

  /// What is said before "prepare": the first word of each line, and the rest of it. Of lines that begin
  /// alike the last one.
  std::map<std::string, std::string> read_introduction();
  /// The next line, without its newline; "end" where mssim has gone.
  std::string next();
  /// Sends a text as one line, of as many bytes as an answer may have at most.
  void answer(std::string text);

 private:
  Descriptor socket_;
  std::string received_;
};

/// What a launcher of MPI and its ranks print, of which some lines say why they have failed.
class LauncherOutput {
 public:
  /// Lines that a reader may want to see are passed on, to a stream that lives as long.
  explicit LauncherOutput(std::ostream& passed_on) : passed_on_(passed_on) {}

  /// The next bytes, which need not end with a line.
  void take(std::string_view bytes);
  /// Whether the ranks have said that they have started (ranks_have_started).
  bool ranks_started() const { return started_; }
  /// Whether a rank has said why it has failed.
  bool rank_has_failed() const { return !of_rank_.empty(); }
  /// Why they have failed, in a sentence: what a rank has said first; or else the last line of the launcher
  /// that names one; or else what Open MPI says first between lines of dashes or asterisks, behind the line
  /// before those, which is ssh's; or else the last line.
  std::string reason() const;

 private:
  void take_line(const std::string& line);

  std::ostream& passed_on_;
  std::string unfinished_, of_rank_, about_rank_, in_frame_, before_frame_, last_;
  bool framed_ = false;  ///< in the first paragraph behind such a line
  bool started_ = false;
};

}  // namespace mssim
