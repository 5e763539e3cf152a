#pragma once

#include <string_view>

namespace mssim {

/// What this program was built from and how: the part of every provenance that is known before a run.
struct BuildInfo {
  std::string_view version;     ///< of the project, for example "0.1.0"
  std::string_view commit;      ///< 40 hex digits, or "unknown" when built outside a git repository
  bool dirty = false;           ///< the program's sources differed from that commit
  std::string_view compiler;    ///< name and version, for example "GNU 12.2.0"
  std::string_view flags;       ///< given to the compiler for every file of the program
  std::string_view build_type;  ///< CMake's, for example "Release"
};

/// Of the running program; lives as long as it does.
const BuildInfo& build_info();

}  // namespace mssim
