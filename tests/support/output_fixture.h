#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <exception>

#include "model/system.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {

/// A rippled cloth; its springs are real, its state is whatever `state_at` says.
inline System small_cloth(std::uint32_t rows, std::uint32_t columns) {
  System system;
  const GridPatch grid{rows, columns, 0.01};
  system.topology = grid;
  system.springs = springs_of(grid);
  system.materials.resize(grid_spring_kinds.size());
  system.node_mass.assign(grid.nodes(), 1e-5);
  system.start.position.resize(grid.nodes());
  system.start.velocity.resize(grid.nodes());
  return system;
}

/// A state in which every number is another one, not exact in single precision and hard to compress.
inline State state_at(const System& system, int frame) {
  State state = system.start;
  for (std::size_t node = 0; node < state.position.size(); ++node) {
    const double number = static_cast<double>(node) + 0.1 * frame;
    state.position[node] = {std::sin(number), std::sin(3 * number), std::sin(5 * number)};
    state.velocity[node] = {std::cos(number), std::cos(3 * number), std::cos(5 * number)};
  }
  return state;
}

/// Runs `body` in a process of its own, where it may change limits and kill itself. Returns what waitpid()
/// says.
inline int status_in_child(const std::function<int()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    int result = 99;
    try {
      result = body();
    } catch (const std::exception& error) {
      (void)!::write(STDERR_FILENO, error.what(), std::string(error.what()).size());
    }
    ::_exit(result);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  return status;
}

/// Takes from root what it may do with every file; false if the system refuses. For a child: there is no way
/// back.
inline bool become_nobody() {
  constexpr uid_t nobody = 65534;
  return ::geteuid() != 0 || ::seteuid(nobody) == 0;
}

/// The exit status of `body`, or -1 when it did not exit.
inline int exit_of_child(const std::function<int()>& body) {
  const int status = status_in_child(body);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Expects what `body` expects, in a process of its own.
inline void expect_in_child(const std::function<void()>& body) {
  EXPECT_EQ(exit_of_child([&] {
              body();
              return testing::Test::HasFailure() ? 1 : 0;
            }),
            0);
}

/// Lets files of this process become no larger, as a full disk does. For a child: there is no way back.
inline void limit_file_size(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace mssim
