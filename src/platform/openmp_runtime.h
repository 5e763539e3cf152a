#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mssim {

/// Starts the program anew, with its arguments, where OpenMP's threads would wait for each other as long as
/// libgomp does by default: some ten milliseconds, in which they spin. On processors that other programs use,
/// two threads then come to lie on one of them, where each spins while the other one should work. libgomp
/// reads how long it spins before main() and never again. To be called first of all in main(); returns where
/// the user has said how to wait (OMP_WAIT_POLICY, GOMP_SPINCOUNT), where the program has been started anew,
/// and where that is impossible. What the program starts itself is told nothing of it.
void start_with_short_waits(char** argv);

/// The stack that threads get: that of any thread, or that which OpenMP gives (OMP_STACKSIZE).
enum class ThreadStack : std::uint8_t { usual, openmp };

/// Why the system does not make so many threads, the calling one included: how many it makes, and what to do.
/// None where it does. Tries it: a thread that cannot be made ends a process that asks OpenMP for it. What
/// has succeeded for OpenMP is not tried again, because OpenMP keeps its threads.
std::optional<std::string> thread_shortage(int threads, ThreadStack stack);

/// How many threads a parallel region can have whose result does not depend on their number: `wanted` (0: as
/// many as OpenMP takes by itself), or where the system does not make so many, as many as it makes.
int openmp_team(int wanted);

}  // namespace mssim
