#include "platform/supervised_process.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "platform/files.h"
#include "platform/machine.h"

namespace mssim {
namespace {

/// Time limit for actions of the supervisor (usually a millisecond) and for the end of killed processes.
constexpr std::chrono::seconds supervisor_patience{30};

std::string reason(int error) { return fmt::format(" ({})", std::strerror(error)); }

[[noreturn]] void fail(const SupervisedProgram& program, const std::string& why) {
  throw std::runtime_error(fmt::format("cannot run {}: {}", program.program.string(), why));
}

std::filesystem::path file_of(const SupervisedProgram& program) { return program.folder / program.program; }

std::string why_not_started(const SupervisedProgram& program, const SupervisorAnswer& answer) {
  switch (answer.word) {
    case SupervisorWord::no_folder:
      return fmt::format("its folder {} cannot be entered{}", program.folder.string(), reason(answer.value));
    case SupervisorWord::no_processors:
      return "it cannot be bound to its CPUs" + reason(answer.value);
    case SupervisorWord::no_program:
      return why_not_executed(file_of(program), answer.value);
    default:
      return "the system has no resources for it" + reason(answer.value);
  }
}

/// Starts the supervisor with only its end of the channel, as descriptor 3; the supervisor closes other
/// inherited descriptors itself.
pid_t start_supervisor(const SupervisedProgram& program, int channel) {
  // The system would report this like a missing program.
  if (::access("/dev/null", R_OK | W_OK) != 0) fail(program, "/dev/null cannot be opened" + reason(errno));
  const std::string supervisor = helper_program("supervise").string();
  std::string cpus;
  for (const int cpu : program.cpus) cpus += fmt::format("{},", cpu);
  std::vector<std::string> words{supervisor, std::to_string(program.removed.size())};
  words.insert(words.end(), program.removed.begin(), program.removed.end());
  words.insert(words.end(), {program.folder.string(), cpus, std::to_string(program.environment.size())});
  words.insert(words.end(), program.environment.begin(), program.environment.end());
  words.push_back(program.program.string());
  words.insert(words.end(), program.arguments.begin(), program.arguments.end());
  const std::vector<char*> arguments = argv_of(words);

  sigset_t none, all;
  ::sigemptyset(&none);
  ::sigfillset(&all);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &all);
  // A session of its own, so no terminal and no Ctrl-C.
  ::posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSID);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, channel, 3);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
  pid_t process = 0;
  const OnAllProcessCpus inherited;
  const int error =
      ::posix_spawn(&process, supervisor.c_str(), &actions, &attributes, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  if (error != 0) fail(program, "mssim's own program " + supervisor + " cannot be started" + reason(error));
  return process;
}

bool receive(int descriptor, void* bytes, std::size_t count) {
  auto* next = static_cast<char*>(bytes);
  while (count > 0) {
    if (!is_readable(descriptor, supervisor_patience)) return false;
    const ssize_t taken = ::recv(descriptor, next, count, 0);
    if (taken < 0 && errno == EINTR) continue;
    if (taken <= 0) return false;
    next += taken;
    count -= static_cast<std::size_t>(taken);
  }
  return true;
}

}  // namespace

std::string describe(const ProgramEnd& end) {
  if (!end.trouble.empty()) return end.trouble;
  if (end.signal == 0) return fmt::format("ended with exit code {}", end.exit_code);
  const char* name = ::sigdescr_np(end.signal);
  return name != nullptr ? fmt::format("was ended by signal {} ({})", end.signal, name)
                         : fmt::format("was ended by signal {}", end.signal);
}

SupervisedProcess::SupervisedProcess(const SupervisedProgram& program) {
  // The system would start it, and only `env` would fail, for lack of "python3\r".
  if (names_interpreter_with_return(file_of(program))) fail(program, why_not_executed(file_of(program), 0));
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    fail(program, "opening a socket failed" + reason(errno));
  channel_ = Descriptor(ends[0]);
  Descriptor other(ends[1]);
  supervisor_ = start_supervisor(program, other.get());
  other.close();
  const std::optional<SupervisorAnswer> answer = hear();
  if (!answer) fail(program, "mssim's own program supervise did not start it");
  if (answer->word != SupervisorWord::started) {
    ::waitpid(supervisor_, nullptr, 0);
    fail(program, why_not_started(program, *answer));
  }
  program_ = answer->value;
}

SupervisedProcess::~SupervisedProcess() { end(std::chrono::milliseconds{0}); }

void SupervisedProcess::pause() {
  if (ask(SupervisorRequest::pause)) paused_ = true;
}

void SupervisedProcess::resume() {
  ask(SupervisorRequest::resume);
  paused_ = false;
}

double SupervisedProcess::processor_seconds() const {
  ask(SupervisorRequest::processor_time);
  return processor_seconds_;
}

std::optional<std::uint64_t> SupervisedProcess::peak_bytes() const {
  const std::optional<SupervisorAnswer> answer = ask(SupervisorRequest::peak_memory);
  return answer && answer->peak_bytes > 0 ? std::optional(answer->peak_bytes) : std::nullopt;
}

const ProgramEnd& SupervisedProcess::end(std::chrono::milliseconds patience) {
  if (ended_) return end_;
  if (paused_ && patience.count() > 0) resume();
  if (!ended_ && !is_readable(channel_.get(), patience)) ::shutdown(channel_.get(), SHUT_WR);
  while (!ended_) hear();
  return end_;
}

/// Sends a request and receives its answer. Nothing if the program has ended.
std::optional<SupervisorAnswer> SupervisedProcess::ask(SupervisorRequest request) const {
  if (ended_) return std::nullopt;
  // If the supervisor is gone, hear() detects it.
  ::send(channel_.get(), &request, sizeof request, MSG_NOSIGNAL);
  return hear();
}

/// Waits for data from the supervisor, and continues it if it was stopped: the program could send signals to
/// its parent. False if there is none in time.
bool SupervisedProcess::says_something() const {
  constexpr std::chrono::milliseconds look{500};
  for (std::chrono::milliseconds waited{0}; waited < supervisor_patience; waited += look) {
    if (is_readable(channel_.get(), look)) return true;
    int status = 0;
    if (::waitpid(supervisor_, &status, WUNTRACED | WNOHANG) == supervisor_ && WIFSTOPPED(status))
      ::kill(supervisor_, SIGCONT);
  }
  return false;
}

/// Receives an answer. Nothing if the program has ended or there is no answer.
std::optional<SupervisorAnswer> SupervisedProcess::hear() const {
  if (!says_something()) {
    lose(
        "was given up, because mssim's program supervise did not answer (a process that SIGKILL does not "
        "end?)");
    return std::nullopt;
  }
  SupervisorAnswer answer;
  if (!receive(channel_.get(), &answer, sizeof answer)) {
    lose("was ended because mssim's program supervise, which monitors it, was ended");
    return std::nullopt;
  }
  processor_seconds_ = std::max(processor_seconds_, answer.processor_seconds);
  if (answer.word != SupervisorWord::ended) return answer;
  take_end(answer);
  return std::nullopt;
}

void SupervisedProcess::take_end(const SupervisorAnswer& answer) const {
  end_.output.resize(std::min(answer.output_bytes, kept_output_bytes));
  if (!receive(channel_.get(), end_.output.data(), end_.output.size())) end_.output.clear();
  if (WIFSIGNALED(answer.value))
    end_.signal = WTERMSIG(answer.value);
  else
    end_.exit_code = WEXITSTATUS(answer.value);
  while (::waitpid(supervisor_, nullptr, 0) < 0 && errno == EINTR) {
  }
  ended_ = true;
}

/// The supervisor is gone or does not answer: kills the known processes of the program.
void SupervisedProcess::lose(const std::string& trouble) const {
  if (program_ > 0) ::kill(-program_, SIGKILL);
  ::shutdown(channel_.get(), SHUT_RDWR);
  ::kill(supervisor_, SIGCONT);  // it may have been stopped again; it now ends by itself
  ::waitpid(supervisor_, nullptr, WNOHANG);
  end_.signal = SIGKILL;
  end_.trouble = trouble;
  ended_ = true;
}

}  // namespace mssim
