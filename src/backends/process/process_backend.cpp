#include "backends/process/process_backend.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <optional>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "backends/process/conversation.h"
#include "backends/process/exchanged_files.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "platform/supervised_process.h"
#include "text/text.h"

namespace mssim {
namespace {

/// NAME=VALUE: the program's environment in addition to this process's. `socket`: mssim's socket. `memory`: a
/// folder that is removed when the program has ended, in shared memory if that has room.
std::vector<std::string> environment_of(const BackendProgram& program, const std::string& socket,
                                        const std::filesystem::path& memory, const Integrator& integrator,
                                        const ExecutionOptions& options) {
  std::string path = variable("PYTHONPATH");
  constexpr std::string_view python_path = "PYTHONPATH=";
  for (const std::string& given : program.environment)
    if (given.starts_with(python_path)) path = given.substr(python_path.size());
  const std::string count = std::to_string(processors_of(program, options));
  std::vector<std::string> all{"MSSIM_SOCKET=" + socket, "MSSIM_THREADS=" + count,
                               "OMP_NUM_THREADS=" + count};
  if (program.in_ranks) {
    all.push_back(fmt::format("MSSIM_RANKS={}", ranks_of(program, options).ranks));
    all.push_back("MSSIM_LAUNCHER=" + options.launcher);
    all.push_back("MSSIM_MEMORY_FOLDER=" + memory.string());
    all.push_back("MSSIM_FOLDER=" + std::filesystem::current_path().string());
    all.push_back("MSSIM_INTEGRATOR=" + std::string(integrator.name));
    all.push_back("MSSIM_SCENE_FILE=" + std::filesystem::absolute(options.scene_file).string());
    all.push_back(std::string("MSSIM_ROOTS=") + (options.roots == Roots::exact ? "exact" : "fast"));
    if (!options.instruction_set.empty()) all.push_back("MSSIM_INSTRUCTION_SET=" + options.instruction_set);
  }
  all.insert(all.end(), program.environment.begin(), program.environment.end());
  // After the description's: mssim's module comes before its folders.
  all.push_back(std::string(python_path) + (data_folder() / "python").string() + (path.empty() ? "" : ":") +
                path);
  return all;
}

/// The first CPUs that mssim may use; empty if the program may use all of them.
std::vector<int> first_cpus(int threads) {
  std::vector<int> cpus = process_cpus();
  if (cpus.size() <= static_cast<std::size_t>(threads)) return {};
  cpus.resize(static_cast<std::size_t>(threads));
  return cpus;
}

using namespace std::chrono_literals;

/// Time for a program to end after it was asked to.
constexpr std::chrono::milliseconds patience = 2s;
/// Time after a program has closed its connection: it may still print the reason, and a launcher takes
/// seconds to learn that its remote processes have ended.
constexpr std::chrono::milliseconds patience_for_reasons = 8s;
/// Maximum number of a program's answers to `prepare`.
constexpr int most_lines = 100;

/// The last line of a program's output that has words: not a frame, and not env's advice after its error.
std::string last_line(std::string_view output) {
  while (!output.empty()) {
    const std::size_t begin = output.find_last_of('\n') + 1;
    const std::string_view line = output.substr(begin);
    if (has_words(line) && line.find("env: use -[v]S to pass options") == std::string_view::npos)
      return printable(line.substr(0, line.find_last_not_of(" \t\r") + 1), longest_shown);
    output = output.substr(0, begin == 0 ? 0 : begin - 1);
  }
  return "";
}

/// This error as the program's failure, with its exit code.
BackendFailure failure_of(const Error& error) {
  BackendFailure failure(error.what(), "");
  failure.exit_code = error.exit_code;
  return failure;
}

/// Calls `work`. A failure with files, sockets or processes concerns only this program: throws BackendFailure
/// for it, with the exit code of the failure if that has one.
template <class Work>
std::invoke_result_t<Work> failing_alone(const Work& work) {
  try {
    return work();
  } catch (const Unavailable&) {
    throw;
  } catch (const Unsupported&) {
    throw;
  } catch (const BackendFailure&) {
    throw;
  } catch (const Error& error) {
    throw failure_of(error);
  } catch (const std::runtime_error& error) {
    throw BackendFailure(error.what(), "");
  }
}

/// Throws Unsupported for scenes and integrators that the program is known not to support.
void require_support(const BackendProgram& program, const System& system, const Integrator& integrator) {
  const bool cloth = std::holds_alternative<GridPatch>(system.topology);
  if (!(cloth ? program.steps_cloths : program.steps_bodies))
    throw Unsupported("it steps {} only", cloth ? "bodies" : "cloths");
  if (const std::string reason = unsupported_reason(program, integrator); !reason.empty())
    throw Unsupported(reason);
}

class ProcessBackend final : public Backend {
 public:
  ProcessBackend(const BackendProgram& program, const System& system, const Integrator& integrator,
                 double dt_s, const ExecutionOptions& options, const std::vector<GridWindow>& windows)
      : program_(program),
        ahead_s_(integrator.ahead * dt_s),
        floor_height_(system.floor.height),
        windows_(windows),
        conversation_(folder_.path()),
        state_file_(windows.empty() ? system.nodes() : windows.front().nodes(), folder_.path()) {
    if (folder_.path().native().find('\n') != std::string::npos)
      throw std::runtime_error(fmt::format(
          "no line to a program can name {}, which has a line break; set TMPDIR to another folder",
          printable(folder_.path().native())));
    const std::filesystem::path system_file = folder_.path() / "system.h5";
    // With several processes, each builds its part of a cloth itself, and the cloth may be large.
    if (!program.in_ranks || !std::holds_alternative<GridPatch>(system.topology))
      write_system(system_file, system);
    const int processors = processors_of(program, options);
    process_.emplace(SupervisedProgram{
        program.program,
        {program.command.begin() + 1, program.command.end()},
        environment_of(program, conversation_.socket().string(), state_file_.path().parent_path(), integrator,
                       options),
        program.folder,
        first_cpus(processors),
        {folder_.path(), state_file_.path().parent_path(), conversation_.socket().parent_path()}});
    const std::string lines =
        fmt::format("mssim-backend 1\nscene {}\ndt {:.17g}\nthreads {}\n{}system {}\nstate {}\nprepare\n",
                    escaped(options.scene), dt_s, processors, method_text(integrator), system_file.string(),
                    state_file_.path().string());
    introduction_.threads = processors;
    conversing([&] {
      conversation_.begin(std::chrono::duration<double>(program.time_limit_s), process_->end_descriptor());
      conversation_.ask(lines, "prepare");
      introduce();
    });
    std::error_code ignored;  // its folder is removed in any case
    std::filesystem::remove(system_file, ignored);
  }

  ~ProcessBackend() override {
    // After an interrupted wait, skip the orderly shutdown.
    if (std::uncaught_exceptions() == 0) end_politely();
  }

  void set_state(const State& state) override {
    if (!windows_.empty()) return request(fmt::format("restart {:.17g}", ahead_s_));
    failing_alone([&] {
      if (ahead_s_ == 0)
        state_file_.write(state);
      else
        state_file_.write(moved_ahead(state, ahead_s_));
    });
    request("set");
  }

  void step(int count) override { request(fmt::format("step {}", count), true); }

  State state() const override {
    if (windows_.empty()) return get("get");
    State all;
    for (const auto& [row, column, rows, columns] : windows_) {
      const State part = get(fmt::format("get {} {} {} {}", row, column, rows, columns));
      for (std::size_t i = 0; i < part.position.size(); ++i) all.add(part.position[i], part.velocity[i]);
    }
    return all;
  }

  std::string device() const override { return introduction_.device; }
  int threads() const override { return introduction_.threads; }
  int steps_per_pass() const override { return introduction_.steps_per_pass; }
  bool runs_on_host() const override {
    return introduction_.device == "cpu" || introduction_.device.starts_with("cpu ");
  }
  bool is_in_single() const override { return introduction_.is_in_single; }
  std::string note() const override { return introduction_.note; }
  std::string reason_not_to_time() const override { return introduction_.untimed; }
  std::string reason_for_excess() const override { return "the program takes them"; }

  void rest() override {
    if (!std::exchange(paused_, true)) process_->pause();
  }
  std::string end() override { return end_politely(); }
  double processor_seconds() const override { return process_->processor_seconds(); }
  bool steps_in_process() const override { return false; }
  std::optional<std::uint64_t> program_peak_bytes() const override { return process_->peak_bytes(); }

  std::optional<Communication> communication() override {
    if (!introduction_.tells_costs) return std::nullopt;
    Communication costs;
    const auto take = [&](const std::string& line) { return take_cost(costs, line); };
    resume();
    conversing([&] {
      conversation_.ask("costs\n", "costs");
      take_answers("costs", take);
    });
    return costs;
  }

 private:
  /// Calls `converse` and turns the program's failures into BackendFailure.
  template <class Converse>
  void conversing(const Converse& converse) const {
    using Cause = ConversationFailure::Cause;
    try {
      converse();
    } catch (const ConversationFailure& failure) {
      if (failure.cause != Cause::closed)
        fail(failure.what(), failure.cause == Cause::silence, failure.cause == Cause::silence);
      pollfd ended{process_->end_descriptor(), POLLIN, 0};
      if (::poll(&ended, 1, static_cast<int>(patience_for_reasons.count())) > 0)
        fail(describe(process_->end(patience)) + ' ' + failure.what(), true);
      fail(std::string("closed its connection ") + failure.what(), true);
    }
  }

  /// Ends the program and throws BackendFailure: its name, this predicate and, if requested, the last line of
  /// its output.
  [[noreturn]] void fail(const std::string& predicate, bool with_last_line = false, bool late = false) const {
    const std::string output = process_->end(0ms).output;
    std::string sentence = program_.name + ' ' + predicate;
    if (const std::string line = last_line(output); with_last_line && !line.empty())
      sentence += "; its last line: " + line;
    throw BackendFailure(sentence, output, late);
  }

  /// Takes lines until the last one.
  template <class Take>
  void take_answers(const std::string& asked, const Take& take) const {
    for (int lines = 0; lines < most_lines; ++lines)
      if (take(conversation_.answer())) return;
    throw ConversationFailure(ConversationFailure::Cause::answer,
                              fmt::format("answered \"{}\" with more than {} lines", asked, most_lines));
  }

  /// Takes the answers to `prepare`. Throws Unsupported and Unavailable.
  void introduce() {
    const auto take = [&](const std::string& line) { return take_introduction(introduction_, line); };
    try {
      take_answers("prepare", take);
    } catch (const Error&) {  // Unsupported or Unavailable: let it end in order
      end_politely();
      throw;
    }
  }

  /// Requests states and reads them.
  State get(const std::string& line) const {
    failing_alone([&] { state_file_.clear(); });
    request(line);
    try {
      State state = state_file_.read();
      if (ahead_s_ != 0) move_back(state, ahead_s_, floor_height_);
      return state;
    } catch (const StateFileFailure& failure) {
      fail(fmt::format("{} when it was asked \"{}\"", failure.what(), line));
    }
  }

  /// Sends a request and waits until it is done. `timed`: the program may report its time.
  void request(const std::string& request, bool timed = false) const {
    resume();
    conversing([&] {
      conversation_.ask(request + '\n', request);
      take_done(request, conversation_.answer(), timed);
    });
  }

  void resume() const {
    if (std::exchange(paused_, false)) process_->resume();
  }

  std::string end_politely() {
    if (!process_) return "";
    resume();
    conversation_.say_last("end\n");
    return process_->end(patience).output;
  }

  const BackendProgram& program_;
  const double ahead_s_;  ///< time by which the program's positions are ahead of the state's
  const double floor_height_;
  const std::vector<GridWindow> windows_;  ///< whose nodes states have; empty: all nodes
  TemporaryFolder folder_;
  // Requests do not change the simulation, so const functions may send them.
  mutable Conversation conversation_;
  mutable bool paused_ = false;
  StateFile state_file_;
  Introduction introduction_;
  mutable std::optional<SupervisedProcess> process_;
};

}  // namespace

std::string unsupported_reason(const BackendProgram& program, const Integrator& integrator) {
  // Without stages to send, a program that only reads stages would do nothing in a step.
  const std::vector<std::string>& known = program.integrators;
  if (known.empty() ? !is_implicit(integrator) : std::ranges::find(known, integrator.name) != known.end())
    return {};
  return fmt::format("it has no {}, only {}", integrator.name,
                     known.empty() ? "explicit integrators" : listed(known));
}

std::string method_text(const Integrator& integrator) {
  std::string text = fmt::format("integrator {}\n", integrator.name);
  for (std::size_t s = 0; s < integrator.stage_count; ++s) {
    const Stage& stage = integrator.stages.at(s);
    text += fmt::format("stage {} {}\n", name_of(position_slot(stage.gather)),
                        name_of(velocity_slot(stage.gather)));
    for (std::size_t i = 0; i < assignment_count(stage); ++i) {
      const Assignment& assignment = stage.assignments.at(i);
      text += fmt::format("assign {}", name_of(assignment.out));
      for (std::size_t t = 0; t < term_count(assignment); ++t) {
        const Term& term = assignment.terms.at(t);
        text += fmt::format(" {:.17g} {} {}", term.coefficient, term.dt_power, name_of(term.slot));
      }
      text += '\n';
    }
  }
  return text;
}

RankCount ranks_of(const BackendProgram& program, const ExecutionOptions& options) {
  const int asked = program.ranks > 0 ? program.ranks : options.ranks;
  if (asked == 0) return {options.threads, 1};
  return {asked, options.threads_given ? options.threads : std::max(1, options.threads / asked)};
}

int processors_of(const BackendProgram& program, const ExecutionOptions& options) {
  if (!program.in_ranks) return options.threads;
  const RankCount count = ranks_of(program, options);
  return count.ranks * count.threads;
}

std::unique_ptr<Backend> make_process_backend(const BackendProgram& program, const System& system,
                                              const Integrator& integrator, double dt_s,
                                              const ExecutionOptions& options,
                                              const std::vector<GridWindow>& windows) {
  if (!program.missing.empty()) throw Unavailable(program.missing);
  require_support(program, system, integrator);
  // Catch these signals even if nothing else does yet: this backend's folders must be removed.
  const EndingSignals during_preparation(note_ending_signal, 0);
  return failing_alone([&] {
    auto backend = std::make_unique<ProcessBackend>(program, system, integrator, dt_s, options, windows);
    // The program has begun at the positions of the state; windows begin with a restart.
    if (integrator.ahead != 0 && windows.empty()) backend->set_state(system.start);
    return backend;
  });
}

}  // namespace mssim
