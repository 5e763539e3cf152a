#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "model/system.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// What a program did with the state file instead of writing a state into it. what() is the predicate of a
/// sentence, without the program's name.
struct StateFileFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The file by which a state goes to a program and comes back: [nodes][3] positions (m), then [nodes][3]
/// velocities (m/s), native doubles. In shared memory (/dev/shm) where it fits. It is never mapped: a program
/// that cuts it would end this one by a signal.
class StateFile {
 public:
  /// Throws std::runtime_error with one sentence where there is no room for it; `elsewhere` is the folder for
  /// it where there is none in shared memory.
  StateFile(std::size_t nodes, const std::filesystem::path& elsewhere);

  const std::filesystem::path& path() const { return path_; }

  void write(const State& state) const;
  /// Fills it with a NaN that no computation makes, so that what is not written afterwards is seen.
  void clear() const;
  /// The state that a program has written since clear(). Throws StateFileFailure where it has not.
  State read() const;

 private:
  bool make(const std::filesystem::path& folder);
  void write_at(std::size_t byte, const void* data, std::size_t bytes) const;

  std::size_t nodes_;
  std::optional<TemporaryFolder> shared_;
  std::filesystem::path path_;
  Descriptor file_;
};

/// Writes what a program must know of a cloth or bodies: an HDF5 file of plain datasets in double precision
/// (docs/protocol.md lists them), each with its unit as an attribute. Throws WriteError.
void write_system(const std::filesystem::path& file, const System& system);

}  // namespace mssim
