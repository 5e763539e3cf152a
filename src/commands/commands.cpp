#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "backends/backend.h"
#include "bench/build_info.h"
#include "commands/bench_command.h"
#include "commands/command.h"
#include "commands/compare_command.h"
#include "commands/exit_code.h"
#include "commands/list_command.h"
#include "commands/measure_command.h"
#include "commands/run_command.h"
#include "commands/run_provenance.h"
#include "mesh/mesh_error.h"
#include "output/csv.h"
#include "output/provenance_file.h"
#include "output/write_error.h"
#include "process/interruption.h"
#include "process/temporary_folder.h"
#include "scene/nearest_name.h"
#include "scene/scene_error.h"

namespace mssim {
namespace {

constexpr std::array<Command, 5> table{{
    {"bench", "time and verify backends on scenes", "mssim bench --scene cloth350k --out results/today",
     declare_bench},
    {"run", "simulate one scene, tracing it into a file",
     "mssim run --scene cloth2500 --duration 1 --trace fall.h5", declare_run},
    {"compare", "say which of two runs is faster, and whether that is certain",
     "mssim compare results/yesterday results/today", declare_compare},
    {"measure", "measure a person's surface, and write a scene of jeans for it",
     "mssim measure scan.obj --scene my.json", declare_measure},
    {"list", "list scenes, suites, backends, ways, integrators or devices", "mssim list scenes --format csv",
     declare_list},
}};

int fail(int code, const std::string& sentence) {
  std::cerr << "mssim: " << sentence << '\n';
  return code;
}

/// Names the exit code of an error; the one place that does.
int run_guarded(const std::function<int()>& run) {
  try {
    return run();
  } catch (const Interrupted& interrupted) {
    remove_temporary_folder_of_process();
    std::signal(interrupted.signal, SIG_DFL);
    std::raise(interrupted.signal);
    return 128 + interrupted.signal;  // where the signal is blocked
  } catch (const NotVerified& error) {
    return fail(exit_not_verified, error.what());
  } catch (const UsageError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const SceneError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const CsvError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const ProvenanceError& error) {
    return fail(exit_bad_input, error.what());
  } catch (const MissingProgram& error) {
    return fail(exit_unavailable, error.what());
  } catch (const Unsupported& error) {
    return fail(exit_bad_input, error.what());
  } catch (const Unavailable& error) {
    return fail(exit_unavailable, error.what());
  } catch (const WriteError& error) {
    return fail(exit_file_error, error.what());
  } catch (const std::bad_alloc&) {
    return fail(exit_bad_input, "the memory does not suffice; close other programs or take a smaller scene");
  } catch (const std::exception& error) {
    return fail(exit_file_error, error.what());
  }
}

}  // namespace

std::span<const Command> commands() { return table; }

int run_program(int argc, char** argv) {
  remember_arguments(argc, argv);
  CLI::App app("mssim " + build_info().version + ": benchmark harness for parallel mass-spring simulation",
               "mssim");
  app.require_subcommand(1);
  app.set_version_flag("--version", "mssim " + build_info().version + " (" + build_info().commit +
                                        (build_info().dirty ? ", changed" : "") + ")");
  std::string examples = "Examples:";
  std::function<int()> run;
  for (const Command& command : commands()) {
    CLI::App* sub = app.add_subcommand(std::string(command.name), std::string(command.description));
    sub->footer("Example:\n  " + std::string(command.example));
    examples += "\n  " + std::string(command.example);
    const std::function<int()> body = command.declare(*sub);
    sub->callback([&run, body] { run = body; });
  }
  app.footer(examples);
  if (argc > 1 && argv[1][0] != '-') {  // the parser would only ask for a subcommand
    std::vector<std::string_view> known;
    for (const Command& command : commands()) known.push_back(command.name);
    if (std::find(known.begin(), known.end(), argv[1]) == known.end())
      return fail(exit_bad_input,
                  "unknown command \"" + std::string(argv[1]) + "\": known are " + listed(known));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(exit_bad_input, std::string(error.what()) + "; see mssim --help");
  }
  const int code = run_guarded(run);
  // Results that could not be written are no results (a full disk; a closed pipe ends the program by
  // SIGPIPE).
  if (!std::cout.flush()) return fail(exit_file_error, "standard output could not be written");
  return code;
}

}  // namespace mssim
