#include <hdf5.h>

#include <csignal>

#include "commands/command.h"
#include "platform/machine.h"

int main(int argc, char** argv) {
  mssim::start_with_short_waits(argv);
  // Before any other call of HDF5, whose own exit handler would crash after a failed flush.
  H5dont_atexit();
  // Beyond `ulimit -f` a write then fails, and the error message names the file.
  std::signal(SIGXFSZ, SIG_IGN);
  return mssim::run_program(argc, argv);
}
