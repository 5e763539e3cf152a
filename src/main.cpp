#include <hdf5.h>

#include <csignal>

#include "commands/command.h"
#include "platform/machine.h"

int main(int argc, char** argv) {
  mssim::start_with_short_waits(argv);
  // Before anything else of HDF5: after a failed flush HDF5's own exit handler would crash.
  H5dont_atexit();
  // Beyond `ulimit -f` a write then fails, and a sentence names the file.
  std::signal(SIGXFSZ, SIG_IGN);
  return mssim::run_program(argc, argv);
}
