// Steps cloths on several processes, on one or several machines: a backend that is a program of its own, so
// mssim does not depend on MPI.

#include <cstring>

#include "platform/machine.h"
#include "ranks/requests.h"

int main(int argc, char** argv) {
  mssim::start_with_short_waits(argv);
  if (argc > 1 && std::strcmp(argv[1], "rank") == 0) return mssim::run_rank(argc, argv);
  return mssim::launch_ranks(argc > 1 && argv[1] == mssim::copies_word);
}
