#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/machine/provenance.h"

namespace mssim {

/// What `mssim doctor` says about one thing that mssim uses.
struct Checkup {
  enum class State : std::uint8_t { ok, limited, missing };
  std::string item = {};
  State state = State::ok;
  std::string found = {};   ///< what is here; may be empty
  std::string use = {};     ///< what it is for
  std::string remedy = {};  ///< how to get it, or more of it; empty if nothing needs to be done
};

/// The processor, and what limits or disturbs a bench of `provenance.threads` threads on it.
std::vector<Checkup> machine_findings(const Provenance& provenance);

}  // namespace mssim
