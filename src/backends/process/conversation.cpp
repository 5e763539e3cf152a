#include "backends/process/conversation.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

/// Maximum length of a line, including its newline.
constexpr std::size_t longest_line = 4096;
/// Interval at which a wait checks the clock, the program and the signals.
constexpr int slice_ms = 100;

/// A folder for sockets if another folder's name is too long: socket names have at most 107 bytes.
constexpr const char* folder_of_short_name = "/tmp";

using Cause = ConversationFailure::Cause;
using namespace std::chrono_literals;

/// The printable form of a line for a sentence.
std::string in_quotes(std::string_view line) { return '"' + printable(line) + '"'; }

constexpr int most_threads = 4096, most_steps_per_pass = 1000;

/// A line's first word, and the rest.
std::pair<std::string_view, std::string_view> split(std::string_view line) {
  const std::size_t space = line.find(' ');
  return {line.substr(0, space), space == std::string_view::npos ? "" : line.substr(space + 1)};
}

[[noreturn]] void refuse(const std::string& line, const std::string& asked, std::string_view expected) {
  throw ConversationFailure(Cause::answer, fmt::format("answered \"{}\" to \"{}\", where {} is expected",
                                                       printable(line), asked, expected));
}

void refuse_failed(const std::string& line, const std::string& asked) {
  const auto [word, text] = split(line);
  if (word == "failed" && !text.empty())
    throw ConversationFailure(Cause::answer,
                              "failed at \"" + asked + "\": " + printable(text, longest_shown));
}

/// The number in an answer to `prepare`, from 1 to `most`; `what` names the things that it counts.
int count_of(std::string_view what, int most, const std::string& line, std::string_view text) {
  const std::optional<int> count = number_in<int>(text);
  if (!count || *count < 1 || *count > most)
    refuse(line, "prepare", fmt::format("a number of {} from 1 to {}", what, most));
  return *count;
}

bool is_at_least_zero(const std::optional<double>& number) {
  return number && *number >= 0 && std::isfinite(*number);
}

/// A cost of `costs`.
struct Cost {
  std::string_view name;
  std::optional<double> Communication::*value;
  double most = std::numeric_limits<double>::max();
};
constexpr Cost known_costs[]{
    {"waiting", &Communication::waiting, 1}, {"packing", &Communication::packing, 1},
    {"bytes", &Communication::bytes},        {"messages", &Communication::messages},
    {"latency", &Communication::latency_s},  {"bandwidth", &Communication::bytes_per_second}};

}  // namespace

Conversation::Conversation(const std::filesystem::path& folder) : socket_(folder / "socket") {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.native().size() >= sizeof address.sun_path)
    socket_ = short_.emplace(folder_of_short_name).path() / "socket";
  std::ranges::copy(socket_.native(), std::begin(address.sun_path));
  listener_ = Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener_.is_open() ||
      ::bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listener_.get(), 2) != 0)
    throw std::runtime_error(
        fmt::format("cannot listen at {} ({}); set TMPDIR to a writable folder, and raise the limit of open "
                    "files (ulimit -n) if it is too low",
                    socket_.string(), std::strerror(errno)));
}

void Conversation::begin(std::chrono::duration<double> time_limit, int end_descriptor) {
  time_limit_ = time_limit;
  end_descriptor_ = end_descriptor;
  deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(time_limit);
  accept();
  // Waiting only for bytes gives the fastest answer; everything else is checked once per slice.
  const timeval slice{0, slice_ms * 1000};
  if (::setsockopt(connection_.get(), SOL_SOCKET, SO_RCVTIMEO, &slice, sizeof slice) != 0)
    throw std::runtime_error(fmt::format("cannot set a socket's time limit ({})", std::strerror(errno)));
}

void Conversation::accept() {
  for (;;) {
    throw_if_ending_signal_noted();
    std::array<pollfd, 2> waiting{{{listener_.get(), POLLIN, 0}, {end_descriptor_, POLLIN, 0}}};
    ::poll(waiting.data(), waiting.size(), slice_ms);
    connection_ = Descriptor(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (connection_.is_open()) return;
    if (errno == EMFILE || errno == ENFILE)
      throw std::runtime_error(std::string("cannot accept the program's connection (") +
                               std::strerror(errno) + "); raise the limit of open files (ulimit -n)");
    if (is_readable(end_descriptor_, 0ms))
      throw ConversationFailure(Cause::closed, "before it connected to MSSIM_SOCKET");
    if (Clock::now() > deadline_)
      throw ConversationFailure(
          Cause::silence, fmt::format("did not connect to MSSIM_SOCKET within {:g} s", time_limit_.count()));
  }
}

void Conversation::ask(std::string_view lines, const std::string& asked) {
  std::array<char, longest_line> early;
  if (received_.empty()) {
    const ssize_t bytes = ::recv(connection_.get(), early.data(), early.size(), MSG_DONTWAIT);
    if (bytes > 0) received_.assign(early.data(), static_cast<std::size_t>(bytes));
  }
  if (!received_.empty())
    throw ConversationFailure(Cause::answer,
                              fmt::format("sent {} after its answer to {}, although nothing was requested",
                                          in_quotes(received_.substr(0, received_.find('\n'))), asked_));
  asked_ = '"' + asked + '"';
  deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(time_limit_);
  while (!lines.empty()) {
    const ssize_t bytes = ::send(connection_.get(), lines.data(), lines.size(), MSG_NOSIGNAL);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) throw ConversationFailure(Cause::closed, "before it was asked " + asked_);
    lines.remove_prefix(static_cast<std::size_t>(bytes));
  }
}

std::string Conversation::answer() {
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = received_.find('\n', searched);
    if (std::min(end, received_.size()) >= longest_line)
      throw ConversationFailure(
          Cause::answer, fmt::format("answered {} with a line of more than {} bytes, which begins {}", asked_,
                                     longest_line, in_quotes(received_.substr(0, 40))));
    if (end != std::string::npos) {
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      return line;
    }
    searched = received_.size();
    throw_if_ending_signal_noted();
    std::array<char, longest_line> bytes;
    // After the deadline, only data that has already arrived counts, even if little is missing.
    const int waiting = Clock::now() > deadline_ ? MSG_DONTWAIT : 0;
    const ssize_t count = ::recv(connection_.get(), bytes.data(), bytes.size(), waiting);
    if (count > 0)
      received_.append(bytes.data(), static_cast<std::size_t>(count));
    else if (count == 0 || (errno != EAGAIN && errno != EINTR))
      throw ConversationFailure(Cause::closed, "before it answered " + asked_);
    else
      look_around();
  }
}

void Conversation::look_around() const {
  throw_if_ending_signal_noted();
  // Everything that it sent before its end has been read.
  if (is_readable(end_descriptor_, 0ms))
    throw ConversationFailure(Cause::closed, "before it answered " + asked_);
  if (is_readable(listener_.get(), 0ms))
    throw ConversationFailure(Cause::answer, "connected a second time before it answered " + asked_);
  if (Clock::now() > deadline_)
    throw ConversationFailure(Cause::silence,
                              fmt::format("did not answer {} within {:g} s", asked_, time_limit_.count()));
}

void Conversation::say_last(std::string_view lines) {
  if (connection_.is_open())
    static_cast<void>(::send(connection_.get(), lines.data(), lines.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

bool take_introduction(Introduction& introduction, const std::string& line) {
  const auto [word, text] = split(line);
  const std::string shown = printable(text, longest_shown);
  if (word == "unsupported" && !text.empty()) throw Unsupported(shown);
  if (word == "unavailable" && !text.empty()) throw Unavailable(shown);
  refuse_failed(line, "prepare");
  if (line == "ready 1") return true;
  if (word == "device" && !text.empty())
    introduction.device = shown;
  else if (word == "threads")
    introduction.threads = count_of("threads", most_threads, line, text);
  else if (word == "pass")
    introduction.steps_per_pass = count_of("steps", most_steps_per_pass, line, text);
  else if (word == "precision" && !text.empty()) {
    introduction.is_in_single = text == "single";
    append_sentence(introduction.note, shown + " precision");
  } else if (word == "note" && !text.empty())
    append_sentence(introduction.note, shown);
  else if (word == "untimed" && !text.empty())
    introduction.untimed = shown;
  else if (line == "tells costs")
    introduction.tells_costs = true;
  else
    refuse(line, "prepare",
           "device, threads, pass, precision, note, untimed, tells costs or ready 1, or unsupported, "
           "unavailable or failed and a reason");
  return false;
}

bool take_cost(Communication& costs, const std::string& line) {
  if (line == "done") return true;
  refuse_failed(line, "costs");
  const auto [word, text] = split(line);
  const auto [name, value] = split(text);
  const std::optional<double> number = number_in<double>(value);
  const Cost* cost = found_in(known_costs, name, &Cost::name);
  if (word != "cost" || !cost || !is_at_least_zero(number) || *number > cost->most)
    refuse(line, "costs",
           "cost waiting or cost packing and a share, cost bytes, cost messages, cost latency or cost "
           "bandwidth and a number, done, or failed and a reason");
  costs.*cost->value = *number;
  return false;
}

void take_done(const std::string& request, const std::string& line, bool timed) {
  if (line == "done") return;
  refuse_failed(line, request);
  const auto [word, text] = split(line);
  if (!(timed && word == "done" && is_at_least_zero(number_in<double>(text))))
    refuse(line, request, "done, or failed and a reason,");
}

}  // namespace mssim
