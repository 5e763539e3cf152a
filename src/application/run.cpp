#include "application/run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <iostream>
#include <limits>
#include <vector>

#include "application/console.h"
#include "backends/backends.h"
#include "bench/estimates.h"
#include "garment/fitting/fitting.h"
#include "garment/stepping/dressing_backend.h"
#include "output/tables/table.h"
#include "output/traces/energy_curve.h"
#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "platform/machine.h"
#include "platform/process.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Number of steps of a plan. Throws UsageError like simulate().
std::int64_t count_steps(const SimulationPlan& plan) {
  // A frame's steps are counted in an int, and beyond 2^53 steps times are not exact.
  constexpr double most_steps = std::numeric_limits<int>::max();
  const double exact_steps = plan.duration_s / plan.dt_s;
  if (!(exact_steps >= 0.5 && exact_steps <= most_steps)) {
    throw UsageError(
        "a duration of {:.6g} s is {:.6g} steps of {:.6g} s; --duration must give between one step and "
        "{:.6g}",
        plan.duration_s, exact_steps, plan.dt_s, most_steps);
  }
  return static_cast<std::int64_t>(std::llround(exact_steps));
}

/// The frames of a simulation with steps of `dt_s`. Throws UsageError for more than one frame per step.
FrameGrid frame_grid(double frames_per_second, double dt_s) {
  const double steps_per_frame = 1 / (frames_per_second * dt_s);
  if (!(steps_per_frame >= 1)) {
    const double unit = std::pow(10, std::floor(std::log10(1 / dt_s)) - 5);  // of the last digit shown
    throw UsageError(
        "{:.6g} frames per second are more than one per step of {:.6g} s; give --fps {:.6g} or less",
        frames_per_second, dt_s, std::floor(1 / dt_s / unit) * unit);
  }
  return {steps_per_frame};
}

}  // namespace

void simulate(Backend& backend, const System& system, const Integrator& integrator,
              const SimulationPlan& plan, const SimulationWatch& watch) {
  const std::int64_t steps = count_steps(plan);
  const FrameGrid grid = frame_grid(plan.frames_per_second, plan.dt_s);
  std::optional<EnergyLedger> ledger;
  if (plan.accounts_for_losses) ledger.emplace(system, integrator, plan.dt_s);
  const auto losses = [&] { return ledger ? std::optional(ledger->losses()) : std::nullopt; };
  backend.set_state(system.start);
  State before = system.start;
  watch.on_frame({0, 0, before, energy_of(system, before), losses()});
  std::int64_t done = 0;
  for (std::int64_t frame = 1; done < steps; ++frame) {
    const std::int64_t next = std::min(steps, grid.step_of(frame));
    const int count = static_cast<int>(next - done);
    if (ledger) {
      for (int step = 0; step < count; ++step) {
        watch.on_progress(done + step, steps);
        ledger->step(backend);
      }
    } else {
      for (int taken = 0, part = 0; taken < count; taken += part) {
        watch.on_progress(done + taken, steps);
        part = std::min(count - taken, most_steps_at_once);
        backend.step(part);
      }
    }
    State state = backend.state();
    if (const auto node = first_bad_node(state)) {
      const BlowUp blow_up = find_blow_up(backend, before, count).value_or(BlowUp{count, *node});
      throw NotVerified("the simulation " + describe(blow_up, plan.dt_s, done, plan.remedy));
    }
    done = next;
    watch.on_frame({done, static_cast<double>(done) * plan.dt_s, state, energy_of(system, state), losses()});
    before = std::move(state);
  }
}

namespace {

/// Headers of the files, and options of the pictures.
struct FileHeaders {
  TraceHeader trace;
  std::string command_line;  ///< in one line, quoted for a shell if necessary; for the energy curve
  PictureOptions pictures;
};

/// Writes the frames of a run into its files while the simulation continues, because compressing a large
/// frame takes as long as many steps. Also keeps their energies.
class RunRecorder {
 public:
  /// Opens the files. Throws WriteError, also if another process writes one of them.
  RunRecorder(const RunFiles& files, const PreparedScene& scene, const FileHeaders& headers)
      : temporary_(files.temporary) {
    if (!files.energy_curve.empty()) {
      std::string comment = headers.command_line;
      if (const std::string_view work = energies_leave_out(scene.system); !work.empty())
        comment.append("\nleft out: ").append(work);
      curve_.emplace(files.energy_curve, comment);
    }
    const Surface body = scene.body ? scene.body->surface : Surface{};
    if (!files.trace.empty()) trace_.emplace(files.trace, scene.system, headers.trace, body);
    if (!files.pictures.empty())
      pictures_.emplace(files.pictures, trace_content_of(scene.system, headers.trace, body),
                        headers.pictures);
  }

  /// Throws WriteError if the previous frame could not be written.
  void record(const Frame& frame) {
    wait_for_frame();
    energies_.push_back({frame.time_s, frame.energy});
    if (!trace_ && !curve_ && !pictures_) return;
    const OnAllProcessCpus unbound;  // not only on the CPU of this thread
    writing_ = std::async(as_the_system_can, [this, frame, state = frame.state] {
      write({frame.step, frame.time_s, state, frame.energy, frame.losses});
    });
  }

  const std::vector<EnergySample>& energies() const { return energies_; }

  /// Runs `simulation`, which records frames, and finishes the files. It finishes them even if the simulation
  /// blows up, is interrupted or its program fails, because the earlier frames are good. Prints the names of
  /// the written files to stderr. If a file cannot be written, the files keep their temporary names and all
  /// frames recorded before, and the WriteError says so. Rethrows the exceptions of `simulation`.
  void finish_after(const std::function<void()>& simulation) {
    try {
      try {
        simulation();
      } catch (const NotVerified&) {
        finish();
        throw;
      } catch (const Interrupted&) {
        finish();
        throw;
      } catch (const BackendFailure&) {
        finish();
        throw;
      }
      finish();
    } catch (const WriteError& error) {
      throw WriteError(error.what() + kept());
    }
  }

 private:
  void write(const Frame& frame) {
    // The curve comes first, so that it has the energies of every frame of the trace, whichever of the two
    // fails.
    if (curve_) curve_->append({frame.time_s, frame.energy});
    if (trace_) trace_->write_frame(frame.step, frame.time_s, frame.state, frame.energy, frame.losses);
    if (pictures_) pictures_->draw(frame.state.position);
  }

  /// Waits until the last frame is written. Throws WriteError on failure.
  void wait_for_frame() {
    if (writing_.valid()) writing_.get();
  }

  void finish() {
    if (energies_.empty()) return;  // files without a frame are removed
    wait_for_frame();
    if (curve_) curve_->close();
    if (trace_) trace_->close();
    if (temporary_) return;
    if (curve_) tell("wrote {}", printable(curve_->name().string(), 1000));
    if (trace_)
      tell("wrote {} and {}", printable(trace_->name().string(), 1000),
           printable(xdmf_of(trace_->name()).string(), 1000));
    if (pictures_)
      tell("wrote {} into {}", pluralize(pictures_->pictures(), "picture"),
           printable(pictures_->name().string(), 1000));
  }

  /// The content of files that did not get their names, as the end of a message.
  std::string kept() {
    std::string text;
    if (temporary_) return text;
    if (trace_) text += kept_in_part(trace_->name(), "frames", trace_->give_up());
    if (curve_) text += kept_in_part(curve_->name(), "energies", curve_->give_up());
    return text;
  }

  bool temporary_;
  std::optional<H5mdTrace> trace_;
  std::optional<EnergyCurve> curve_;
  std::optional<PictureFolder> pictures_;
  std::vector<EnergySample> energies_;
  std::future<void> writing_;  ///< of a frame; nothing else accesses the files meanwhile
};

/// The files that a run reads: those of the scene, and the program of the backend, its description and the
/// files of its command.
std::vector<NamedFile> files_read(const PreparedScene& scene, const BackendInfo& backend) {
  std::vector<NamedFile> files;
  for (const std::filesystem::path& file : scene.files) files.push_back({"a file of the scene", file});
  if (const BackendProgram* program = backend.program) {
    files.push_back({"the program of the backend", program->program});
    const std::string before_ranks = program->name.substr(0, program->name.find(':'));
    files.push_back({"the description of the backend", program->folder / (before_ranks + ".json")});
    for (const std::string& word : program->command)
      if (std::error_code error; std::filesystem::is_regular_file(program->folder / word, error))
        files.push_back({"a file of the backend's command", program->folder / word});
  }
  return files;
}

/// Throws UsageError if two of these are the same file: the files, the XDMF of the trace, and those that are
/// read; and for an extension of the energy curve that is not CSV's.
void require_distinct(const RunFiles& files, const std::vector<NamedFile>& read) {
  std::vector<NamedFile> written;
  if (!files.trace.empty()) {
    written.push_back({"--trace", files.trace});
    written.push_back({"the XDMF beside --trace", xdmf_of(files.trace)});
  }
  if (!files.energy_curve.empty()) written.push_back({"--energy-curve", files.energy_curve});
  if (!files.pictures.empty()) written.push_back({"--pictures", files.pictures});
  if (files.later) written.push_back(*files.later);
  require_distinct(written, read);
  if (!files.energy_curve.empty()) require_extension({"--energy-curve", files.energy_curve}, "CSV", {".csv"});
}

/// Throws UsageError if the backend is to step in double precision and does not do so here.
void require_precision(const RunOptions& options, const BackendInfo& info, const System& system,
                       const Integrator& integrator) {
  const bool garment = is_garment(system), only_reference = garment || is_implicit(integrator);
  const auto steps = only_reference
                         ? +[](const BackendInfo& row) { return row.role == BackendRole::baseline; }
                         : [](const BackendInfo& row) { return row.make_in_double != nullptr; };
  if (info.in_double && !steps(info))
    throw UsageError(
        "{} in double precision needs --precision double with --backend {}, not \"{}\"; a program chooses "
        "its precision itself",
        garment          ? "a garment"
        : only_reference ? "an implicit integrator"
                         : "a run",
        names_of(steps, "or"), options.backend);
}

/// Makes the chosen backend with make(execution). Throws Unsupported and Unavailable with the backend's name.
template <class Make>
auto chosen_backend(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                    const Integrator& integrator, const Make& make) {
  require_precision(options, info, scene.system, integrator);
  ExecutionOptions execution = complete(options.execution);
  execution.scene = scene.spec.name;
  execution.scene_file = scene.spec.file;
  auto backend = [&] {
    try {
      return make(execution);
    } catch (const Unsupported& reason) {
      throw Unsupported("{}: {}", options.backend, reason.what());
    } catch (const Unavailable& reason) {
      throw Unavailable("{}: {}", options.backend, reason.what());
    }
  }();
  if (info.uses_device) tell_of_opencl();
  if (const std::string excess = excess_of(info, *backend, execution); !excess.empty())
    tell("{} runs {}", options.backend, excess);
  return backend;
}

/// Prints the backend's note on its steps.
void tell_note(const RunOptions& options, const Backend& backend) {
  if (const std::string note = backend.note(); !note.empty()) tell("{}: {}", options.backend, note);
}

/// Warns if accounting takes long.
void warn_of_slow_accounting(const SimulationPlan& plan, const System& system, const Integrator& integrator) {
  constexpr double passes_for_energies = 4;
  constexpr double springs_per_second = 1e8;  // of the double-precision reference, approximately
  constexpr double patience_s = 10;
  const double seconds = static_cast<double>(count_steps(plan)) * static_cast<double>(system.springs.size()) *
                         (passes_for_energies + expected_evaluations(integrator)) / springs_per_second;
  if (seconds > patience_s)
    tell("--losses takes a double-precision step for every step, about {:.6g} s in all", std::round(seconds));
}

/// The sum of energies and losses at the end, less that at the start, divided by the largest change of one
/// kind of energy between frames; ideally zero.
std::optional<double> energy_imbalance(const std::vector<EnergySample>& curve, const EnergyLosses& losses) {
  double in_motion = 0;
  for (const auto kind : {&Energy::kinetic, &Energy::elastic, &Energy::gravitational}) {
    const auto [low, high] =
        std::ranges::minmax(curve, {}, [&](const EnergySample& sample) { return sample.energy.*kind; });
    in_motion = std::max(in_motion, high.energy.*kind - low.energy.*kind);
  }
  if (in_motion == 0) return std::nullopt;
  return (curve.back().energy.total() + losses.total() - curve.front().energy.total()) / in_motion;
}

/// A sentence if the total energy has grown by more than all energy that could move: the kinetic and elastic
/// energy at the start, and what gravity gave. Then the steps of an explicit integrator are too long, though
/// all numbers are finite. (With long steps implicit ones stretch springs, too, and recover.)
std::string blow_up_of_energy(const System& system, const Integrator& integrator,
                              const std::vector<EnergySample>& curve, std::string_view remedy) {
  if (is_implicit(integrator)) return "";
  const Energy& first = curve.front().energy;
  double given = 0;
  for (const EnergySample& sample : curve)
    given = std::max(given, first.gravitational - sample.energy.gravitational);
  const double could_move =
      std::max(first.kinetic + first.elastic + given, energy_in_motion(system, system.start, Energy{}));
  const EnergySample& largest =
      *std::ranges::max_element(curve, {}, [](const EnergySample& sample) { return sample.energy.total(); });
  const double growth = largest.energy.total() - first.total();
  if (growth <= could_move) return "";
  return fmt::format(
      "the simulation blew up: its energy has grown by {:.3g} J at {:.6g} s, and the scene has {:.3g} J that "
      "can move; {}",
      growth, largest.time_s, could_move, remedy);
}

FileHeaders headers_of(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                       const Backend& backend, const Integrator& integrator) {
  if (!options.files.any()) return {};
  Provenance provenance = run_provenance(backend.threads(), info.uses_device);
  add_execution(provenance, {&info}, complete(options.execution));
  add_scene(provenance, scene.spec.name, scene.spec.source);
  FileHeaders headers{trace_header(scene, backend, info, integrator, provenance),
                      join(mapped<std::string>(provenance.command_line, shell_word), " "), options.pictures};
  headers.pictures.threads = complete(options.execution).threads;
  headers.trace.with_losses = options.losses;
  return headers;
}

/// Dresses the scene's garment until it has settled, for at most --duration. Unless silent, prints the course
/// and the fit; prints violated bounds to stderr. Records the start, the frames of the grid and the final
/// state. Returns an ExitCode. Throws NotVerified with the step if the simulation blows up, WriteError and
/// Interrupted.
int run_garment(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                const Integrator& integrator, const SimulationPlan& plan) {
  const auto backend =
      chosen_backend(options, info, scene, integrator, [&](const ExecutionOptions& execution) {
        if (info.in_double) return make_reference_dressing(scene.system, integrator, scene.dt_s);
        return make_dressing_backend(info, scene.system, integrator, scene.dt_s, execution);
      });
  if (options.losses)
    throw UsageError(
        "--losses cannot be used with a garment: the work of its seams and contacts is not accounted for; "
        "leave it out");
  const FileHeaders headers = headers_of(options, info, scene, *backend, integrator);
  // After the headers, which load libraries that catch signals themselves, and before any file exists.
  StopRequest stop;
  const FrameGrid frames = frame_grid(plan.frames_per_second, plan.dt_s);
  SettlingRule rule;
  if (options.duration_s) rule.longest_s = static_cast<double>(count_steps(plan)) * plan.dt_s;
  RunRecorder recorder(options.files, scene, headers);
  const auto require_finite = [&plan](const State& state, std::int64_t iterations) {
    if (const auto node = first_bad_node(state))
      throw NotVerified("the simulation blew up before step {}: node {} is not finite; {}", iterations, *node,
                        plan.remedy);
  };
  const auto record = [&](const State& state, std::int64_t iterations) {
    require_finite(state, iterations);
    recorder.record({iterations, static_cast<double>(iterations) * scene.dt_s, state,
                     energy_of(scene.system, state), std::nullopt});
    stop.throw_if_requested();
  };
  DressingResult result;
  double seconds = 0;
  recorder.finish_after([&] {
    const Stopwatch watch;
    ProgressLine progress({1}, ProgressLine::Log::nothing);
    progress.begin_scene(scene.spec.name);
    progress.update("closing seams", 0);
    result = dress(*backend, scene.system, scene.dt_s, rule,
                   [&](const State& state, std::int64_t iterations) {
                     require_finite(state, iterations);
                     stop.throw_if_requested();
                     const auto activity =
                         fmt::format("{}, {:.2f} s simulated of at most {:.2f}",
                                     backend->progress().draping ? "draping" : "closing seams",
                                     static_cast<double>(iterations) * scene.dt_s, rule.longest_s);
                     progress.update(activity, 0);  // the time of settling is unknown
                     return true;
                   },
                   {frames, options.files.any() ? std::function(record) : nullptr,
                    [&stop] { stop.throw_if_requested(); }});
    seconds = watch.seconds();
  });
  tell_note(options, *backend);
  const Fit fit = fit_of(scene.system, result.state.position, fit_body(scene.body));
  Table dressing, fitting;
  dressing.add({{"scene", scene.spec.name},
                {"backend", info.name},
                {"threads", backend->threads()},
                {"nodes", scene.system.nodes()},
                {"dt_s", scene.dt_s},
                {"seamed_at", result.seamed_at},
                {"iterations", result.iterations},
                {"simulated_s", result.simulated_s},
                {"wall_s", seconds},
                {"ms_per_iteration", 1e3 * seconds / static_cast<double>(result.iterations)}});
  for (const FitCheck& check : fit_checks(fit, {}))
    fitting.add(
        {{"fit", check.name}, {"value", check.value}, {"bound", check.bound}, {"within", check.within}});
  if (!options.silent)
    std::cout << record_text(dressing, terminal_of(STDOUT_FILENO).width) << '\n' << to_text(fitting);
  const std::vector<std::string> found = misfits(result, fit, {});
  for (const std::string& misfit : found) tell("{}: {}", scene.spec.name, misfit);
  return found.empty() ? exit_ok : exit_not_verified;
}

int run_simulation(const RunOptions& options, const BackendInfo& info, const PreparedScene& scene,
                   const Integrator& integrator, const SimulationPlan& plan) {
  const auto backend =
      chosen_backend(options, info, scene, integrator, [&](const ExecutionOptions& execution) {
        if (info.in_double && is_implicit(integrator))
          return make_reference(scene.system, integrator, scene.dt_s);
        return make_backend(info, scene.system, integrator, scene.dt_s, execution);
      });
  const FileHeaders headers = headers_of(options, info, scene, *backend, integrator);
  StopRequest stop;  // as in run_garment
  RunRecorder recorder(options.files, scene, headers);
  if (plan.accounts_for_losses) warn_of_slow_accounting(plan, scene.system, integrator);
  std::int64_t steps = 0;
  std::optional<EnergyLosses> losses;
  double seconds = 0;
  recorder.finish_after([&] {
    const Stopwatch watch;
    ProgressLine progress({1}, ProgressLine::Log::nothing);
    progress.begin_scene(scene.spec.name);
    simulate(*backend, scene.system, integrator, plan,
             {[&](const Frame& frame) {
                recorder.record(frame);
                steps = frame.step;
                losses = frame.losses;
                stop.throw_if_requested();
              },
              [&](std::int64_t done, std::int64_t all) {
                progress.update_often(fmt::format("step {} of {}", done, all),
                                      static_cast<double>(done) / static_cast<double>(all));
                stop.throw_if_requested();
              }});
    seconds = watch.seconds();
  });
  tell_note(options, *backend);

  const std::vector<EnergySample>& curve = recorder.energies();
  const auto loss = [&](double EnergyLosses::*kind) { return losses ? Cell(*losses.*kind) : Cell(); };
  const Energy &first = curve.front().energy, &last = curve.back().energy;
  Table table;
  table.add({{"scene", scene.spec.name},
             {"backend", info.name},
             {"device", device_name(backend->device())},
             {"threads", backend->threads()},
             {"integrator", options.integrator},
             {"dt_s", scene.dt_s},
             {"steps", steps},
             {"simulated_s", curve.back().time_s},
             {"wall_s", seconds},
             {"kinetic_j", last.kinetic},
             {"elastic_j", last.elastic},
             {"gravitational_j", last.gravitational},
             {"total_change_j", last.total() - first.total()},
             {"damping_loss_j", loss(&EnergyLosses::damping)},
             {"friction_loss_j", loss(&EnergyLosses::friction)},
             {"bounce_loss_j", loss(&EnergyLosses::bounce)},
             {"integration_loss_j", loss(&EnergyLosses::integration)},
             {"energy_imbalance", losses ? Cell(energy_imbalance(curve, *losses)) : Cell()}});
  if (!options.silent) std::cout << record_text(table, terminal_of(STDOUT_FILENO).width);
  const std::string blow_up = blow_up_of_energy(scene.system, integrator, curve, plan.remedy);
  if (!blow_up.empty()) tell(blow_up);
  return blow_up.empty() ? exit_ok : exit_not_verified;
}

}  // namespace

int run_scene(RunOptions options) {
  const auto require_trace_name = [&] {
    if (options.files.trace.empty()) return;
    if (const auto problem = trace_name_problem(options.files.trace))
      throw UsageError("--trace: " + *problem);
  };
  require_trace_name();
  for (std::string* file : {&options.files.trace, &options.files.energy_curve})
    if (!file->empty()) *file = target_of(*file).string();
  require_trace_name();
  const Integrator& integrator = require_integrator(options.integrator);
  BackendChoice choice(with_garment_backends(table_backends()), options.own_backends, {options.scene});
  BackendInfo info = choice.require(options.backend);
  const bool chooses_itself =
      info.program && !is_shipped(std::string(info.name.substr(0, info.name.find(':'))));
  if ((info.in_double || chooses_itself) && options.precision == "single")
    throw UsageError("--precision single cannot be used with --backend {}{}: leave one of them out",
                     options.backend, chooses_itself ? ", which chooses its precision itself" : "");
  info.in_double |= options.precision == "double";
  require_use_of_options(options.execution, {&info});
  PreparedScene scene = prepare_scene(find_scene(options.scene));
  warn_of_note(scene);
  require_distinct(options.files, files_read(scene, info));
  // Finds an unwritable file before anything is simulated.
  if (options.files.later) AtomicFile(options.files.later->path).remove();
  if (options.dt_s) scene.dt_s = *options.dt_s;
  const SimulationPlan plan{scene.dt_s, options.duration_s.value_or(default_duration_s),
                            options.fps.value_or(std::min(options.usual_fps, 1 / scene.dt_s)), options.losses,
                            options.dt_s ? "take a smaller --dt, or leave it out" : shorter_scene_step};
  try {
    return is_garment(scene.system) ? run_garment(options, info, scene, integrator, plan)
                                    : run_simulation(options, info, scene, integrator, plan);
  } catch (const BackendFailure& failure) {
    // A bench keeps it in a file.
    std::cerr << failure.output << (failure.output.empty() || failure.output.ends_with('\n') ? "" : "\n");
    throw;
  }
}

}  // namespace mssim
