#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "bench/machine/provenance.h"
#include "text/error.h"

namespace mssim {

/// Thrown for a provenance.json that cannot be read or understood; what() is one sentence that names the
/// file, the place in it (a JSON pointer such as /cpu/model), the value and the remedy. Commands end with
/// exit code 2.
struct ProvenanceError : ErrorWith<exit_bad_input> {
  using ErrorWith::ErrorWith;
};

/// Larger files are refused: a provenance has a few thousand bytes, and a wrong file should fill neither the
/// memory nor a message.
inline constexpr std::size_t largest_provenance_bytes = std::size_t{256} << 10;

/// The text of provenance.json, indented, without a newline at its end. Numbers are finite; what is not known
/// is absent or null.
std::string provenance_text(const Provenance& provenance);

/// Reads what provenance_text wrote. Every value must be what it should; what mssim has written from the
/// first must be there, and what a newer one adds is ignored. Throws ProvenanceError.
Provenance read_provenance(const std::filesystem::path& file);

/// Reads a text; `file` is named in messages. Throws like read_provenance.
Provenance parse_provenance(const std::filesystem::path& file, std::string_view text);

}  // namespace mssim
