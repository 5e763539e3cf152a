#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "backends/interface/backend.h"
#include "integrators/all_integrators.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "ranks/piece.h"
#include "ranks/requests.h"
#include "scene/scene_file.h"
#include "text/text.h"

namespace mssim {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// Time limit for the launcher to start all ranks.
constexpr std::chrono::seconds start_limit = 25s;
/// Time for the launcher to end its ranks when it must end.
constexpr std::chrono::seconds patience = 3s;

/// A running launcher.
class Launcher {
 public:
  Launcher(const std::filesystem::path& program, std::vector<std::string> words) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0)
      throw std::runtime_error(fmt::format("cannot make a pipe ({})", std::strerror(errno)));
    output_ = Descriptor(ends[0]);
    const Descriptor written(ends[1]);
    const std::vector<char*> arguments = argv_of(words);
    const OnAllProcessCpus inherited;  // OpenMP may have bound this thread, which computes nothing
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(written.get(), STDOUT_FILENO);
      ::dup2(written.get(), STDERR_FILENO);
      ::execv(program.c_str(), arguments.data());
      // The only thread, so any function may be called.
      std::cerr << "cannot run " << program.string() << ": " << why_not_executed(program, errno) << std::endl;
      _exit(127);
    }
    if (process_ < 0) throw std::runtime_error(fmt::format("cannot fork ({})", std::strerror(errno)));
  }

  /// Forwards printed output until the launcher ends. False if it does not end: it did not start the ranks in
  /// time, or a rank has failed and the launcher does not learn that remote ranks have ended. Output of ranks
  /// that outlive it is forwarded for some seconds.
  bool watch(LauncherOutput& printed) {
    Clock::time_point limit = Clock::now() + start_limit;
    bool failed = false;
    for (;;) {
      if (is_readable(output_.get(), 100ms)) {
        std::array<char, 4096> bytes;
        const ssize_t count = ::read(output_.get(), bytes.data(), bytes.size());
        if (count > 0) printed.take({bytes.data(), static_cast<std::size_t>(count)});
        if (count == 0) break;
      }
      if (printed.rank_has_failed() && !std::exchange(failed, true)) limit = Clock::now() + patience;
      if (!status_ && has_ended(WNOHANG)) limit = Clock::now() + patience;
      if (Clock::now() <= limit) continue;
      if (status_) break;
      if (failed || !printed.ranks_started()) return false;
    }
    if (!status_) has_ended(0);
    return true;
  }

  /// Ends the launcher, and through it the ranks if it still responds.
  void end() {
    ::kill(process_, SIGTERM);
    const Clock::time_point limit = Clock::now() + patience;
    while (!has_ended(WNOHANG)) {
      if (Clock::now() > limit) ::kill(process_, SIGKILL);
      std::this_thread::sleep_for(10ms);
    }
  }

  bool succeeded() const { return status_ && WIFEXITED(*status_) && WEXITSTATUS(*status_) == 0; }
  /// The signal that ended it, or nothing.
  std::optional<int> signal() const {
    return status_ && WIFSIGNALED(*status_) ? std::optional(WTERMSIG(*status_)) : std::nullopt;
  }

 private:
  /// Whether it has ended; stores its status. Waits for that unless `options` is WNOHANG.
  bool has_ended(int options) {
    int status = 0;
    if (::waitpid(process_, &status, options) != process_) return false;
    status_ = status;
    return true;
  }

  Descriptor output_;
  pid_t process_ = -1;
  std::optional<int> status_;
};

/// Defaults for Open MPI and Slurm, unless the user has set these variables.
void set_defaults() {
  const auto set = [](const char* name, const char* value) { ::setenv(name, value, 0); };
  // Ranks bind themselves, whatever the launcher.
  set("OMPI_MCA_hwloc_base_binding_policy", "none");
  // Send columns and ghosts in one piece: from 4 KB on, ranks of a machine would first agree on each message.
  set("OMPI_MCA_btl_vader_eager_limit", "65536");
  // Slurm: the ranks of several rows and integrators exist at the same time, in one allocation.
  set("SLURM_OVERLAP", "1");
  // Open MPI leaves files behind; mssim removes the contents of its socket's folder.
  ::setenv("TMPDIR", std::filesystem::path(variable("MSSIM_SOCKET", "/tmp/")).parent_path().c_str(), 1);
  // For mssim's own threads only: with them all ranks would start on the same CPU.
  for (const char* name : {"OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY"}) ::unsetenv(name);
}

/// Tells mssim why nothing is launched.
int answer_alone(const std::string& answer) {
  Requests requests;
  requests.read_introduction();
  requests.answer(answer);
  return 0;
}

/// Throws Unsupported for problems that otherwise all ranks would find after their start.
void require_cuttable(int ranks) {
  const Integrator* integrator = find_integrator(variable("MSSIM_INTEGRATOR"));
  if (integrator != nullptr) require_cut(load_scene(variable("MSSIM_SCENE_FILE")), *integrator, ranks);
}

}  // namespace

int launch_ranks(bool copies) {
  const std::string launcher = variable("MSSIM_LAUNCHER", "mpirun");
  const std::string ranks = variable("MSSIM_RANKS", "1");
  std::istringstream in(launcher);
  std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
  try {
    if (words.empty()) throw std::runtime_error("MSSIM_LAUNCHER is empty");
    // The user's file names in --launcher are relative to the folder where mssim was started.
    const std::string folder = variable("MSSIM_FOLDER", ".");
    if (::chdir(folder.c_str()) != 0)
      throw std::runtime_error("cannot enter " + folder + " (" + std::strerror(errno) +
                               "), where mssim was started; start it in another folder");
    const auto program = find_program(words.front());
    if (!program && words.front().find('/') != std::string::npos)
      return answer_alone("unavailable " + words.front() +
                          " is not an executable file: name another launcher (--launcher), or chmod +x it");
    if (!program)
      return answer_alone("unavailable there is no " + words.front() +
                          " in PATH: install Open MPI (Debian: openmpi-bin), or name another launcher "
                          "(--launcher)");
    if (!copies) require_cuttable(number_in<int>(ranks).value_or(1));
    words.insert(words.end(),
                 {"-n", ranks, std::filesystem::read_symlink("/proc/self/exe").string(), "rank"});
    if (copies) words.emplace_back(copies_word);
    set_defaults();
    LauncherOutput printed(std::cerr);
    Launcher running(*program, words);
    const bool ended = running.watch(printed);
    if (!ended) running.end();
    if (!ended && !printed.rank_has_failed()) {
      std::cerr << launcher << " has not started " << ranks << " ranks within " << start_limit.count()
                << " s; do all hosts answer? It says: " << printed.reason() << '\n';
      return 1;
    }
    if (running.succeeded()) return 0;
    if (const auto signal = running.signal(); ended && signal) {
      std::cerr << launcher << " was ended by signal " << *signal << '\n';
      return 1;
    }
    std::string reason = printed.reason();
    if (reason.find("attempt to run as root") != std::string::npos) {
      // Open MPI's own advice follows in a later paragraph.
      if (reason.ends_with('.')) reason.pop_back();
      append_sentence(reason, "set OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
    }
    std::cerr << (printed.ranks_started() ? "" : launcher + " has not started " + ranks + " ranks: ")
              << reason << '\n';
  } catch (const Unsupported& unsupported) {
    return answer_alone(std::string("unsupported ") + unsupported.what());
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return 1;
}

}  // namespace mssim
