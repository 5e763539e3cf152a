// Descriptions of backends: what is accepted can be run, or says why not.

#include "backends/described/backend_description.h"
#include "fuzz_checks.h"
#include "scene/fields/fields.h"

namespace mssim {
namespace {

void check(const BackendProgram& program) {
  require(!program.command.empty() && !program.command.front().empty(), "a command has a program");
  require(program.program.is_absolute() || !program.missing.empty(), "what can be run is found");
  require(program.steps_cloths || program.steps_bodies, "a program steps something");
  require(program.time_limit_s > 0 && program.time_limit_s <= longest_time_limit_s, "limits are positive");
  if (!program.missing.empty()) require_sentence(program.missing);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(text_of(data, size));
  if (const auto program = unless_refused<SceneError>([&] { return parse_description("mine.json", text); }))
    check(*program);
  return 0;
}

}  // namespace mssim
