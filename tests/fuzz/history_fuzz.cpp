// A history of times, which `history` and `report` read.

#include "fuzz_checks.h"
#include "output/folders/history_file.h"
#include "text/error.h"

namespace mssim {

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto found = unless_refused<Error>([&] { return parse_history("fuzz.jsonl", text_of(data, size)); });
  if (!found) return 0;
  const auto text = [](const std::vector<HistoryEntry>& history) {
    std::string lines;
    for (const HistoryEntry& entry : history) lines += history_line(entry) + '\n';
    return lines;
  };
  const std::string written = text(*found);
  require(text(parse_history("again.jsonl", written)) == written, "a written history reads back");
  return 0;
}

}  // namespace mssim
