#pragma once

#include <cstddef>

namespace mssim {

// What mssim (supervised_process.cpp) and libexec/mssim/supervise (src/supervise.cpp) say to each other. The
// supervisor's arguments: COUNT PATH... FOLDER CPUS COUNT NAME=VALUE... PROGRAM ARGUMENT..., where COUNT is
// the number of what follows, PATHs are removed where mssim has ended before the program, and CPUS is as
// "0,1," or empty. Descriptor 3 is its end of the channel, a stream.

/// One byte from mssim. Each is answered. When mssim closes its end, the supervisor ends everything.
enum class SupervisorRequest : char { pause, resume, processor_time };

/// What the supervisor answers.
enum class SupervisorWord : int {
  no_process,     ///< it cannot make a pipe or a process; value: errno
  no_folder,      ///< the program's folder cannot be entered; value: errno
  no_processors,  ///< the program cannot be bound to its processors; value: errno
  no_program,     ///< the program cannot be executed; value: errno
  started,        ///< value: the program's process, which is its process group as well
  done,           ///< what was asked for has been done
  ended           ///< the program and all that it started are gone; value: as waitpid has it
};

/// An answer; the last output follows it when the program has ended.
struct SupervisorAnswer {
  SupervisorWord word = SupervisorWord::no_process;
  int value = 0;
  double processor_seconds = 0;  ///< with done and ended
  std::size_t output_bytes = 0;  ///< with ended
};

/// How much of the output is kept.
inline constexpr std::size_t kept_output_bytes = 64 * 1024;

}  // namespace mssim
