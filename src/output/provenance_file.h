#pragma once

#include <filesystem>
#include <stdexcept>

#include "bench/provenance.h"

namespace mssim {

/// Thrown for a provenance.json that cannot be read or understood; what() is one sentence that names the
/// file, the place in it (a JSON pointer such as /cpu/model), the value and the remedy. Commands end with
/// exit code 2.
struct ProvenanceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Larger files are refused: no provenance needs a tenth of it, and a wrong file should not fill the memory.
inline constexpr std::size_t largest_provenance_bytes = std::size_t{4} << 20;

/// Reads what to_json(Provenance) wrote. Every value must be what it should; what mssim has written from the
/// first must be there, and what a newer one adds is ignored. Throws ProvenanceError.
Provenance read_provenance(const std::filesystem::path& file);

}  // namespace mssim
