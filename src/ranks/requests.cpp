#include "ranks/requests.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace mssim {

Requests::Requests() : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const char* path = std::getenv("MSSIM_SOCKET");
  if (!path || !*path)
    throw std::runtime_error(
        "MSSIM_SOCKET is not set: mssim starts this program (mssim bench --backend mpi)");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (std::strlen(path) >= sizeof address.sun_path)
    throw std::runtime_error(
        "the path of the socket in MSSIM_SOCKET is too long: set TMPDIR to a shorter one");
  std::strcpy(address.sun_path, path);
  if (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error(std::string("cannot connect to ") + path + " (" + std::strerror(errno) + ')');
}

std::map<std::string, std::string> Requests::read_introduction() {
  std::map<std::string, std::string> introduction;
  for (std::string line = next(); line != "prepare"; line = next()) {
    if (line == "end") throw std::runtime_error("mssim has gone before it said all");
    const std::size_t space = line.find(' ');
    introduction[line.substr(0, space)] = space == std::string::npos ? "" : line.substr(space + 1);
  }
  return introduction;
}

std::string Requests::next() {
  for (;;) {
    if (const std::size_t end = received_.find('\n'); end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return line;
    }
    std::array<char, 4096> bytes;
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return "end";
    received_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

void Requests::answer(std::string_view line) {
  std::string text(line);
  text += '\n';
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t count = ::send(socket_.get(), rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // next() says that mssim has gone
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string in_one_line(std::string text) {
  constexpr std::size_t longest = 4000;  // an answer has at most 4,096 bytes
  std::ranges::replace(text, '\n', ' ');
  return text.substr(0, longest);
}

}  // namespace mssim
