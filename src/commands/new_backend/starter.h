#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace mssim {

/// What a backend to start from is written in.
enum class StarterLanguage : std::uint8_t { python, cpp };

/// A file of a backend to start from.
struct StarterFile {
  std::filesystem::path name;
  std::string text;
  bool executable = false;
  bool shared = false;  ///< the same for every backend: one that stands there already serves this one, too
};

/// A backend to start from: a working example and what goes with it, and how to use it.
struct Starter {
  std::vector<StarterFile> files;
  std::vector<std::string> commands;  ///< for a shell, in the order of their use
};

/// The starter of that name, whose files are to lie in `folder`. Throws UsageError for a name that would not
/// work.
Starter starter_of(const std::string& name, StarterLanguage language, const std::filesystem::path& folder);

}  // namespace mssim
