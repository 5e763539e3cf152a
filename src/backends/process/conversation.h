#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "backends/interface/backend.h"
#include "platform/files.h"
#include "platform/process.h"

namespace mssim {

/// Why a conversation cannot continue. what() is the program's action without its name: "did not answer ...".
struct ConversationFailure : std::runtime_error {
  enum class Cause {
    silence,  ///< no answer in time
    closed,   ///< connection lost: the program has ended, or has closed its socket
    answer    ///< an invalid answer, or one that reports a failure
  };
  Cause cause;

  ConversationFailure(Cause why, const std::string& sentence) : std::runtime_error(sentence), cause(why) {}
};

/// Lines of text with one program over a Unix socket: mssim listens, the program connects once and answers
/// each request. The program's output is limited in length and time. All calls throw ConversationFailure, and
/// Interrupted (platform/process.h) within a tenth of a second after an ending signal.
class Conversation {
 public:
  /// Listens at a socket in `folder`, or in a new folder in /tmp if the name is too long for a socket. Throws
  /// std::runtime_error with one sentence if that fails.
  explicit Conversation(const std::filesystem::path& folder);

  const std::filesystem::path& socket() const { return socket_; }

  /// Sets the time limit for the program's connection and for every answer, and waits for the connection.
  /// `end_descriptor` becomes readable when the program has ended.
  void begin(std::chrono::duration<double> time_limit, int end_descriptor);

  /// Sends lines, each ended by a newline, that request one answer. `asked` names the request in messages. An
  /// answer that arrived before its request is an error.
  void ask(std::string_view lines, const std::string& asked);

  /// The program's next line, without its newline. The time limit counts from ask().
  std::string answer();

  /// If the program has connected: sends a last line without an answer; nothing is read afterwards.
  void say_last(std::string_view lines);

 private:
  using Clock = std::chrono::steady_clock;

  void accept();
  /// Checks, after a tenth of a second without an answer, whether one can still come.
  void look_around() const;

  std::optional<TemporaryFolder> short_;
  std::filesystem::path socket_;
  Descriptor listener_, connection_;
  std::chrono::duration<double> time_limit_{};
  int end_descriptor_ = -1;
  Clock::time_point deadline_;
  std::string asked_;     ///< in quotes
  std::string received_;  ///< received part of the next line, possibly more
};

/// Maximum number of characters of a program's text that are shown.
inline constexpr std::size_t longest_shown = 300;

/// The program's properties from its answers to `prepare`.
struct Introduction {
  std::string device = "cpu";
  int threads = 0;
  int steps_per_pass = 0;    ///< as Backend::steps_per_pass
  bool is_in_single = true;  ///< as Backend::is_in_single
  std::string note;
  std::string untimed;
  bool tells_costs = false;  ///< it supports the request `costs`
};

// Parsers of a program's answers; each throws ConversationFailure for an unexpected line.

/// One of the answers to `prepare`; returns true for the last. Throws the Unsupported and Unavailable that
/// the program reports.
bool take_introduction(Introduction& introduction, const std::string& line);

/// One of the answers to `costs`; returns true for the last.
bool take_cost(Communication& costs, const std::string& line);

/// The answer to any other request: done. `timed`: it may include the time that it took.
void take_done(const std::string& request, const std::string& line, bool timed);

}  // namespace mssim
