#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "model/system.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// The program's failure to write a state into the state file. what() is the predicate of a sentence, without
/// the program's name.
struct StateFileFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The file that passes states to and from a program: [nodes][3] positions (m), then [nodes][3] velocities
/// (m/s), native doubles. In shared memory (/dev/shm) if it fits. It is never mapped: a program that
/// truncates it would crash this process.
class StateFile {
 public:
  /// Throws std::runtime_error with one sentence if there is no room; `elsewhere` is the folder for it if
  /// shared memory has no room.
  StateFile(std::size_t nodes, const std::filesystem::path& elsewhere);

  const std::filesystem::path& path() const { return path_; }

  void write(const State& state) const;
  /// Fills it with a NaN that no computation produces, so that missing values are detected.
  void clear() const;
  /// The state that a program has written since clear(). Throws StateFileFailure if it has not.
  State read() const;

 private:
  bool make(const std::filesystem::path& folder);
  void write_at(std::size_t byte, std::string_view bytes) const;

  std::size_t nodes_;
  std::optional<TemporaryFolder> shared_;
  std::filesystem::path path_;
  Descriptor file_;
};

/// Writes the data of a cloth or bodies for a program: an HDF5 file of plain datasets in double precision
/// (docs/protocol.md lists them), each with its unit as an attribute. Throws WriteError.
void write_system(const std::filesystem::path& file, const System& system);

}  // namespace mssim
