// provenance.json, which `compare` and `bench --resume` read.

#include "fuzz_checks.h"
#include "output/folders/provenance_file.h"

namespace mssim {

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto found =
      unless_refused<ProvenanceError>([&] { return parse_provenance("fuzz.json", text_of(data, size)); });
  if (!found) return 0;
  const std::string written = provenance_text(*found);
  require(provenance_text(parse_provenance("again.json", written)) == written,
          "a written provenance reads back");
  return 0;
}

}  // namespace mssim
