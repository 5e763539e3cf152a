#pragma once

#include <string>

namespace mssim {

/// What a program was built from and how: the part of every provenance that is known before a run.
struct BuildInfo {
  std::string version;     ///< of the project, for example "0.1.0"
  std::string commit;      ///< 40 hex digits, or "unknown" when built outside a git repository
  bool dirty = false;      ///< the program's sources differed from that commit
  std::string compiler;    ///< name and version, for example "GNU 12.2.0"
  std::string flags;       ///< given to the compiler for all that is timed
  std::string build_type;  ///< CMake's, for example "Release"
};

/// What the running program was built from.
const BuildInfo& build_info();

}  // namespace mssim
