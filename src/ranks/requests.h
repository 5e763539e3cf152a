#pragma once

#include <map>
#include <ostream>
#include <string>
#include <string_view>

#include "platform/process.h"

namespace mssim {

// Texts by which the ranks, within their output, report to the process that started the launcher
// (launch_ranks).

/// The argument of mssim-mpi and its ranks that makes each step the whole scene.
inline constexpr std::string_view copies_word = "copies";

/// Once on stdout: MPI has started on all hosts.
inline constexpr std::string_view ranks_have_started = "mssim-mpi: all ranks have started";

/// On stderr, before the sentence with which a rank fails.
inline constexpr std::string_view sentence_mark = "mssim-mpi: ";

/// The program that mssim starts: runs the launcher of MPI (MSSIM_LAUNCHER, default `mpirun`) with
/// MSSIM_RANKS times `mssim-mpi rank`, or `mssim-mpi rank copies`, forwards their output, and waits for its
/// end. If they fail, the last line on stderr is the reason. Returns the exit code.
int launch_ranks(bool copies);

/// The program that an MPI launcher starts once per rank (`mssim-mpi rank`): steps a part of the scene, or
/// (`mssim-mpi rank copies`) the whole; rank 0 communicates with mssim. Returns the exit code. If a rank
/// fails, its sentence is on stderr, and all ranks are ended.
int run_rank(int argc, char** argv);

/// The program's side of the protocol of own backends (docs/protocol.md), line by line.
class Requests {
 public:
  /// Connects to the socket that MSSIM_SOCKET names. Throws std::runtime_error with one sentence.
  Requests();

  /// The lines before "prepare": the first word of each line, and its rest. If a keyword repeats, the last
  /// line wins.
  std::map<std::string, std::string> read_introduction();
  /// The next line, without its newline; "end" if mssim has ended.
  std::string next();
  /// Sends a text as one line, cut to the maximum length of an answer.
  void answer(std::string text);

 private:
  Descriptor socket_;
  std::string received_;
};

/// The output of an MPI launcher and its ranks; some lines are reasons for a failure.
class LauncherOutput {
 public:
  /// Forwards lines for the reader to a stream, which must outlive this object.
  explicit LauncherOutput(std::ostream& passed_on) : passed_on_(passed_on) {}

  /// The next bytes, which may end within a line.
  void take(std::string_view bytes);
  /// Whether the ranks have printed that they have started (ranks_have_started).
  bool ranks_started() const { return started_; }
  /// Whether a rank has printed why it failed.
  bool rank_has_failed() const { return !of_rank_.empty(); }
  /// Why they failed, in a sentence: the first one of a rank; else the launcher's last line that names a
  /// rank; else Open MPI's first paragraph between lines of dashes or asterisks, after the preceding line,
  /// which is ssh's; else the last line.
  std::string reason() const;

 private:
  void take_line(const std::string& line);

  std::ostream& passed_on_;
  std::string unfinished_, of_rank_, about_rank_, in_frame_, before_frame_, last_;
  bool framed_ = false;  ///< in the first paragraph after such a line
  bool started_ = false;
};

}  // namespace mssim
