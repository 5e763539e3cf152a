#include "backends/devices/device_queue.h"

#include <stdexcept>

#include "platform/files.h"

namespace mssim {

std::string program_text(int lanes, std::initializer_list<const char*> files) {
  std::string text = fmt::format("#define MSSIM_LANES {}\n", lanes);
  for (const char* file : files)
    text += read_file_or<std::runtime_error>(data_folder() / "kernels" / file,
                                             "the OpenCL backends are made from it");
  return text;
}

std::string slices_program_text(std::size_t slice_nodes, int lanes,
                                std::initializer_list<const char*> files) {
  return fmt::format("#define MSSIM_SLICE {}\n{}", slice_nodes, program_text(lanes, files));
}

cl::Program DeviceQueue::build(const std::string& text) const {
  const cl::Device device(device_.id, true);
  const bool exact =
      (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  const CompileTimer timer;
  cl::Program program(context_, text);
  try {
    program.build(device, exact ? "-cl-fp32-correctly-rounded-divide-sqrt" : "");
  } catch (const cl::BuildError& error) {
    std::string log = error.getBuildLog().empty() ? "" : error.getBuildLog().front().second;
    log = log.substr(0, log.find('\n', log.find("error")));
    throw Unavailable("{} on {}: {}", opencl_failure(error.what(), error.err()),
                      device.getInfo<CL_DEVICE_NAME>(), log);
  }
  return program;
}

}  // namespace mssim
