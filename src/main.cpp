#include <hdf5.h>

#include "commands/shared/command.h"

int main(int argc, char** argv) {
  // First of all: after a failed flush HDF5's own exit handler would crash.
  H5dont_atexit();
  return mssim::run_program(argc, argv);
}
