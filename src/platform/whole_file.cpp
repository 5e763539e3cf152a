#include "platform/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

#include "platform/descriptor.h"
#include "text/printable.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;
using Cause = ReadError::Cause;

[[noreturn]] void fail(const std::string& what, const std::error_code& error, const std::string& remedy) {
  throw ReadError(Cause::other, what + " (" + error.message() + "): " + remedy);
}

std::error_code last_error() { return {errno, std::generic_category()}; }

[[noreturn]] void refuse_size(std::size_t most_bytes) {
  constexpr std::size_t mebibyte = std::size_t{1} << 20;
  throw ReadError(Cause::too_large,
                  "is longer than " + (most_bytes < mebibyte ? std::to_string(most_bytes >> 10) + " KiB"
                                                             : std::to_string(most_bytes >> 20) + " MiB"));
}

}  // namespace

std::string ReadError::sentence(const fs::path& file, std::string_view remedy) const {
  std::string text = printable(file.string(), 1000) + ": " + what();
  if (cause != Cause::other) text.append(": ").append(remedy);
  return text;
}

void require_regular_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) throw ReadError(Cause::missing, "there is no such file");
  if (error) fail("cannot be looked up", error, "check the path and its permissions");
  if (!fs::is_regular_file(status)) throw ReadError(Cause::not_regular, "is not a regular file");
}

std::string read_file(const fs::path& file, std::size_t most_bytes) {
  require_regular_file(file);
  const Descriptor open(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (!open.is_open()) fail("cannot be opened", last_error(), "check its permissions");
  std::error_code error;
  if (const std::uintmax_t bytes = fs::file_size(file, error); !error && bytes > most_bytes)
    refuse_size(most_bytes);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  // The length is counted while reading, too, because the one that the file system states can be wrong
  // (/proc).
  while (true) {
    const ssize_t bytes = ::read(open.get(), block.data(), block.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) fail("cannot be read", last_error(), "check the file and its disk");
    if (bytes == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(bytes));
    if (text.size() > most_bytes) refuse_size(most_bytes);
  }
}

}  // namespace mssim
