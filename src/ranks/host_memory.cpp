#include "ranks/host_memory.h"

#include <string>

#include "backends/interface/backend.h"
#include "platform/machine.h"

namespace mssim {

void require_memory(const Session& session, std::uint64_t bytes) {
  const auto here = static_cast<std::uint64_t>(session.ranks_on_host());
  std::string sentence;
  if (const auto shortage = memory_shortage(here * bytes))
    sentence = session.name_of(session.rank()) + (here > 1 ? " with the others there " : " ") + *shortage +
               ": take more machines, or make the scene smaller";
  for (const std::string& other : session.gather(sentence))
    if (!other.empty()) throw Unavailable(other);
}

}  // namespace mssim
