#include "ranks/requests.h"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "text/text.h"

namespace mssim {

Requests::Requests() : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const std::string path = variable("MSSIM_SOCKET");
  if (path.empty())
    throw std::runtime_error(
        "MSSIM_SOCKET is not set: mssim starts this program (mssim bench --backend mpi)");
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path)
    throw std::runtime_error(
        "the path of the socket in MSSIM_SOCKET is too long: set TMPDIR to a shorter one");
  std::ranges::copy(path, std::begin(address.sun_path));
  if (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error(fmt::format("cannot connect to {} ({})", path, std::strerror(errno)));
}

std::map<std::string, std::string> Requests::read_introduction() {
  std::map<std::string, std::string> introduction;
  for (std::string line = next(); line != "prepare"; line = next()) {
    if (line == "end") throw std::runtime_error("mssim has ended before its last line");
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

void Requests::answer(std::string text) {
  constexpr std::size_t longest = 4000;  // mssim accepts 4,096 bytes
  std::ranges::replace(text, '\n', ' ');
  text.resize(std::min(text.size(), longest));
  text += '\n';
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t count = ::send(socket_.get(), rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // next() reports that mssim has ended
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
}

void LauncherOutput::take(std::string_view bytes) {
  unfinished_ += bytes;
  for (std::size_t end = unfinished_.find('\n'); end != std::string::npos; end = unfinished_.find('\n')) {
    take_line(unfinished_.substr(0, end));
    unfinished_.erase(0, end + 1);
  }
}

std::string LauncherOutput::reason() const {
  for (const std::string* text : {&of_rank_, &about_rank_})
    if (!text->empty()) return *text;
  if (!in_frame_.empty()) return before_frame_ + (before_frame_.empty() ? "" : "; ") + in_frame_;
  return last_.empty() ? "it printed nothing" : last_;
}

void LauncherOutput::take_line(const std::string& line) {
  if (line == ranks_have_started) {
    started_ = true;
    return;
  }
  if (line.starts_with("mpirun: Forwarding signal")) return;  // for each pause by mssim
  passed_on_ << line << '\n';
  if (const std::size_t mark = line.find(sentence_mark); mark != std::string::npos && of_rank_.empty())
    of_rank_ = line.substr(mark + sentence_mark.size());
  // "process rank 1 with PID 7 on node a exited on signal 9 (Killed)" (mpirun), "a: task 1: Killed" (srun)
  if (line.find(" rank ") != std::string::npos || line.find(" task ") != std::string::npos)
    about_rank_ = line;
  // Open MPI's occasional note that its ssh ended before it could be put into a group: not a reason.
  if (line.find("plm:rsh: Warning: setpgid(") != std::string::npos) return;
  const bool is_blank = line.find_first_not_of(" \t\r") == std::string::npos;
  const bool is_frame = !is_blank && !has_words(line);
  if (is_frame || is_blank) {
    framed_ = is_frame && in_frame_.empty();
    if (framed_) before_frame_ = last_;
    return;
  }
  last_ = line;
  if (framed_) in_frame_ += (in_frame_.empty() ? "" : " ") + line;
}

}  // namespace mssim
