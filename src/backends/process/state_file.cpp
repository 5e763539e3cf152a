#include "backends/process/state_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "text/text.h"

namespace mssim {
namespace {

constexpr const char* shared_memory = "/dev/shm";

static_assert(sizeof(Vec3d) == 3 * sizeof(double), "the file has three numbers a node");

/// A quiet NaN with letters for a payload.
constexpr std::uint64_t unwritten = 0x7ff86d737369'6d21;

bool is_unwritten(const Vec3d& vector) {
  return std::ranges::any_of(std::array{vector.x, vector.y, vector.z},
                             [](double number) { return std::bit_cast<std::uint64_t>(number) == unwritten; });
}

std::size_t bytes_of(std::size_t nodes) { return 2 * sizeof(Vec3d) * nodes; }

/// Reads the whole of `data`, from that byte on; false where the file ends before it.
bool read_at(const Descriptor& file, std::size_t byte, void* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t count = ::pread(file.get(), data, bytes, static_cast<off_t>(byte));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data = static_cast<char*>(data) + count;
    byte += static_cast<std::size_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace

StateFile::StateFile(std::size_t nodes, const std::filesystem::path& elsewhere) : nodes_(nodes) {
  if (::access(shared_memory, W_OK) == 0) {
    shared_.emplace(shared_memory);
    if (make(shared_->path())) return;
    shared_.reset();
  }
  if (!make(elsewhere))
    throw std::runtime_error("cannot make " + path_.string() + " of " + std::to_string(bytes_of(nodes)) +
                             " bytes (" + std::strerror(errno) + "); set TMPDIR to a folder with more room");
}

bool StateFile::make(const std::filesystem::path& folder) {
  path_ = folder / "state";
  file_ = Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file_.is_open()) return false;
  // Room that is there now will not be missing in the middle of a run.
  const int error = ::posix_fallocate(file_.get(), 0, static_cast<off_t>(bytes_of(nodes_)));
  errno = error;
  return error == 0;
}

void StateFile::write_at(std::size_t byte, const void* data, std::size_t bytes) const {
  while (bytes > 0) {
    const ssize_t count = ::pwrite(file_.get(), data, bytes, static_cast<off_t>(byte));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      throw std::runtime_error("cannot write " + path_.string() + " (" + std::strerror(errno) +
                               "); make room there");
    data = static_cast<const char*>(data) + count;
    byte += static_cast<std::size_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
}

void StateFile::write(const State& state) const {
  const std::size_t half = sizeof(Vec3d) * nodes_;
  write_at(0, state.position.data(), half);
  write_at(half, state.velocity.data(), half);
}

void StateFile::clear() const {
  constexpr std::size_t numbers = 8192;
  const std::vector<double> block(numbers, std::bit_cast<double>(unwritten));
  const std::size_t bytes = bytes_of(nodes_);
  for (std::size_t byte = 0; byte < bytes; byte += numbers * sizeof(double))
    write_at(byte, block.data(), std::min(numbers * sizeof(double), bytes - byte));
}

State StateFile::read() const {
  State state;
  state.position.resize(nodes_);
  state.velocity.resize(nodes_);
  const std::size_t half = sizeof(Vec3d) * nodes_;
  if (!read_at(file_, 0, state.position.data(), half) || !read_at(file_, half, state.velocity.data(), half)) {
    struct stat status {};
    ::fstat(file_.get(), &status);
    throw StateFileFailure("left a state file of " +
                           pluralize(static_cast<std::uint64_t>(status.st_size), "byte") + " instead of " +
                           std::to_string(bytes_of(nodes_)));
  }
  const auto missing = static_cast<std::size_t>(std::ranges::count_if(state.position, is_unwritten) +
                                                std::ranges::count_if(state.velocity, is_unwritten));
  if (missing > 0)
    throw StateFileFailure("wrote " + std::to_string(2 * nodes_ - missing) + " of the " +
                           std::to_string(2 * nodes_) + " positions and velocities of the state file");
  return state;
}

}  // namespace mssim
