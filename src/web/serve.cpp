#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iostream>

#include "platform/process.h"
#include "text/error.h"
#include "text/text.h"
#include "web/web.h"

namespace mssim {
namespace {

constexpr std::size_t largest_request_bytes = std::size_t{64} << 20;

/// A listening socket on the loopback address, which no other machine can reach.
Descriptor listener(int port, std::string& address) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  // Connections of a server that ended keep its port for a minute otherwise.
  const int yes = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  at.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t size = sizeof at;
  auto* name = reinterpret_cast<sockaddr*>(&at);
  if (::bind(socket.get(), name, size) != 0 || ::listen(socket.get(), 8) != 0 ||
      ::getsockname(socket.get(), name, &size) != 0)
    throw UsageError("cannot serve on port {} ({}): give another --port", port, std::strerror(errno));
  address = fmt::format("http://localhost:{}/", ntohs(at.sin_port));
  return socket;
}

/// The value of a header of a request, whose names have any case; empty if it has none. `name`: in lower
/// case.
std::string header(std::string_view head, std::string_view name) {
  const std::string before = fmt::format("\r\n{}:", name);
  const std::size_t line = to_lower(head).find(before);
  if (line == std::string::npos) return {};
  std::string_view value = head.substr(line + before.size());
  value = value.substr(0, value.find("\r\n"));
  while (value.starts_with(' ')) value.remove_prefix(1);
  return std::string(value);
}

struct Request {
  std::string line, body;                ///< the first line, for example "GET / HTTP/1.1"
  std::string status = {}, reason = {};  ///< of the answer if it is refused
};

/// When a client that sends or reads little by little is given up: others wait meanwhile.
std::chrono::steady_clock::time_point deadline_of_client() {
  return std::chrono::steady_clock::now() + std::chrono::seconds(10);
}

/// Reads a request; all empty if none arrives as a whole. `address`: the page's.
Request read_request(int socket, const std::string& address) {
  const auto deadline = deadline_of_client();
  std::string text;
  std::size_t end = std::string::npos, length = 0;
  std::array<char, 65536> bytes;
  while (end == std::string::npos || text.size() < end + 4 + length) {
    if (std::chrono::steady_clock::now() > deadline) return {};
    const ssize_t count = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (count <= 0) return {};
    text.append(bytes.data(), static_cast<std::size_t>(count));
    const auto refused = [&](const char* status, const std::string& reason) {
      return Request{text.substr(0, text.find("\r\n")), {}, status, reason};
    };
    const auto too_large = [&] {
      return refused(
          "413 Content Too Large",
          fmt::format("the request is longer than {} MiB: send fewer results", largest_request_bytes >> 20));
    };
    if (text.size() > largest_request_bytes) return too_large();
    if (end != std::string::npos || (end = text.find("\r\n\r\n")) == std::string::npos) continue;
    const std::string_view head = std::string_view(text).substr(0, end + 2);
    // A page of another host must not post results: neither under a name of its own that leads here, nor from
    // its own origin.
    const std::string host = header(head, "host"), origin = header(head, "origin");
    const std::string name = host.substr(0, host.find(':'));  // a client leaves port 80 out
    if (name != "localhost" && name != "127.0.0.1")
      return refused("403 Forbidden", fmt::format("the request is for the host \"{}\": open the page as {}",
                                                  printable(host), address));
    if (!origin.empty() && origin != "http://" + host)
      return refused("403 Forbidden", fmt::format("the request is from a page of \"{}\": open mssim's as {}",
                                                  printable(origin), address));
    length = number_in<std::size_t>(header(head, "content-length")).value_or(0);
    if (length > largest_request_bytes) return too_large();
  }
  return {text.substr(0, text.find("\r\n")), text.substr(end + 4, length)};
}

/// `only_head`: without the body, whose length the head states all the same.
void answer(int socket, std::string_view status, std::string_view type, std::string_view body,
            bool only_head = false) {
  // Isolation from other origins makes the browser's clock finer, and lets threads of the page share memory.
  std::string text = fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}; charset=utf-8\r\nContent-Length: {}\r\nConnection: close\r\n"
      "Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Embedder-Policy: require-corp\r\n\r\n",
      status, type, body.size());
  if (!only_head) text += body;
  const auto deadline = deadline_of_client();
  for (std::string_view rest = text; !rest.empty();) {
    if (std::chrono::steady_clock::now() > deadline) return;
    const ssize_t count = ::send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count <= 0) return;
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// Reads what a client still sends after its answer. Closing the connection instead would take the answer
/// away from it.
void drain(int socket) {
  ::shutdown(socket, SHUT_WR);
  const auto deadline = deadline_of_client();
  std::array<char, 65536> bytes;
  while (std::chrono::steady_clock::now() < deadline && ::recv(socket, bytes.data(), bytes.size(), 0) > 0) {
  }
}

}  // namespace

void serve_page(int port, bool once, const std::function<std::string(const std::string& text)>& taken) {
  std::string address;
  const Descriptor socket = listener(port, address);
  const std::string page = web_page(true);
  std::cout << address << std::endl;
  for (;;) {
    const Descriptor connection(::accept4(socket.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (!connection.is_open()) continue;
    // A browser may connect long before it asks, or never ask, or never read the answer.
    const timeval patience{.tv_sec = 2, .tv_usec = 0};
    for (const int wait : {SO_RCVTIMEO, SO_SNDTIMEO})
      ::setsockopt(connection.get(), SOL_SOCKET, wait, &patience, sizeof patience);
    Request request = read_request(connection.get(), address);
    const bool only_head = request.line.starts_with("HEAD ");
    if (only_head) request.line.replace(0, 4, "GET");
    if (!request.status.empty()) {
      answer(connection.get(), request.status, "text/plain", request.reason, only_head);
      drain(connection.get());
    } else if (request.line.starts_with("GET / ") || request.line.starts_with("GET /?")) {
      answer(connection.get(), "200 OK", "text/html", page, only_head);
    } else if (request.line.starts_with("POST /results ")) {
      try {
        answer(connection.get(), "200 OK", "text/plain", taken(request.body));
        if (once) return;
      } catch (const Error& error) {
        answer(connection.get(), "400 Bad Request", "text/plain", error.what());
      }
    } else if (!request.line.empty()) {
      answer(connection.get(), "404 Not Found", "text/plain", "there is only the page /", only_head);
    }
  }
}

}  // namespace mssim
