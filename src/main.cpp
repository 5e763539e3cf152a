#include <hdf5.h>

#include "commands/shared/command.h"
#include "platform/openmp_runtime.h"

int main(int argc, char** argv) {
  mssim::start_with_short_waits(argv);
  // Before anything else of HDF5: after a failed flush HDF5's own exit handler would crash.
  H5dont_atexit();
  return mssim::run_program(argc, argv);
}
