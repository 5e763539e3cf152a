#pragma once

#include <cstdint>
#include <string_view>

namespace mssim {

/// Throws InputError unless `metres`, which is `what`, is between a tenth of a millimetre and a kilometre:
/// coordinates are rounded to micrometres.
void require_length(double metres, std::string_view what);

/// Throws InputError unless `cells`, which are `what`, are from `smallest` to 1,000.
void require_cells(std::uint32_t cells, std::uint32_t smallest, std::string_view what);

}  // namespace mssim
