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

/// Why a conversation cannot go on. what() is what the program did, without its name: "did not answer ...".
struct ConversationFailure : std::runtime_error {
  enum class Cause {
    silence,  ///< no answer in time
    closed,   ///< no connection any more: the program has ended, or has closed its socket
    answer    ///< an answer that is none
  };
  Cause cause;

  ConversationFailure(Cause why, const std::string& sentence) : std::runtime_error(sentence), cause(why) {}
};

/// Lines of text with one program over a Unix socket: mssim listens, the program connects once, and then each
/// line that mssim asks something with is answered. What the program sends is bounded in length and in time.
/// All calls throw ConversationFailure, and Interrupted (platform/process.h) within a tenth of a second
/// after the user has asked mssim to end.
class Conversation {
 public:
  /// Listens at a socket in this folder; in one of its own in /tmp where the folder's name is too long for a
  /// socket's. Throws std::runtime_error with one sentence where that cannot be.
  explicit Conversation(const std::filesystem::path& folder);

  const std::filesystem::path& socket() const { return socket_; }

  /// Waits so long for the program to connect, and for every answer. `end_descriptor` becomes readable when
  /// the program has ended.
  void begin(std::chrono::duration<double> time_limit, int end_descriptor);

  /// Sends lines, each ended by a newline, of which an answer is expected. `asked` says in messages what they
  /// ask for. An answer that came before it was asked for is an error.
  void ask(std::string_view lines, const std::string& asked);

  /// The next line that the program sends, without its newline. The time counts from ask().
  std::string answer();

  /// Where the program has connected: tells it something that is not answered, and nothing of what it sends
  /// is read any more.
  void say_last(std::string_view lines);

 private:
  using Clock = std::chrono::steady_clock;

  void accept();
  /// Looks after a tenth of a second without an answer whether one can still come.
  void look_around() const;

  std::optional<TemporaryFolder> short_;
  std::filesystem::path socket_;
  Descriptor listener_, connection_;
  std::chrono::duration<double> time_limit_{};
  int end_descriptor_ = -1;
  Clock::time_point deadline_;
  std::string asked_;     ///< in quotes
  std::string received_;  ///< what has come of the next line, and perhaps more
};

/// An answer that says that the program has failed, or that is none. what() is the predicate of a sentence,
/// without the program's name: "failed at ...".
struct AnswerFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Characters of what a program says that are shown at most.
inline constexpr std::size_t longest_shown = 300;

/// What a program says of itself before it is ready.
struct Introduction {
  std::string device = "cpu";
  int threads = 0;
  std::string note;
  std::string untimed;
  bool tells_costs = false;  ///< it knows the request `costs`
};

// Each takes a line that a program answers, and throws AnswerFailure for one that is not expected.

/// One of the answers to `prepare`; true where it is the last. Throws Unsupported and Unavailable as the
/// program says them.
bool take_introduction(Introduction& introduction, const std::string& line);

/// One of the answers to `costs`; true where it is the last.
bool take_cost(Communication& costs, const std::string& line);

/// The answer to any other request: that it is done. `timed`: it may say how long that took.
void take_done(const std::string& request, const std::string& line, bool timed);

}  // namespace mssim
