// Surfaces in OBJ files.

#include "fuzz_checks.h"
#include "mesh/surface_file.h"
#include "surface_checks.h"
#include "text/error.h"

namespace mssim {

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto surface = unless_refused<InputError>([&] { return parse_obj("fuzz.obj", text_of(data, size)); });
  if (surface) check_surface(*surface);
  return 0;
}

}  // namespace mssim
