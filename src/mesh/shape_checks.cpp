#include "mesh/shape_checks.h"

#include <string>

#include "geometry/geometry.h"
#include "text/error.h"

namespace mssim {

void require_length(double metres, std::string_view what) {
  if (!(metres >= 1e-4 && metres <= 1000))
    throw InputError(std::string(what) + " is " + decimal(metres) +
                     " m; give a length from 0.0001 to 1000 m");
}

void require_cells(std::uint32_t cells, std::uint32_t smallest, std::string_view what) {
  constexpr std::uint32_t largest = 1000;
  if (cells < smallest || cells > largest)
    throw InputError(std::string(what) + " are " + std::to_string(cells) + "; give a number from " +
                     std::to_string(smallest) + " to " + std::to_string(largest));
}

}  // namespace mssim
