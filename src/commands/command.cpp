#include "commands/command.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>
#include <system_error>
#include <vector>

#include "application/console.h"
#include "application/outputs.h"
#include "backends/backends.h"
#include "backends/devices/drivers.h"
#include "bench/machine/provenance.h"
#include "commands/arguments/program_parser.h"
#include "platform/files.h"
#include "platform/process.h"
#include "scene/scene_file.h"
#include "text/error.h"
#include "text/text.h"

namespace mssim {
namespace {

constexpr auto table = std::to_array<Command>({
    {"bench", "Time every backend on scenes, and verify each result",
     "mssim bench --scene cloth350k --out results/today", declare_bench},
    {"run", "Simulate one scene; optionally write a trace or an energy curve",
     "mssim run --scene cloth2500 --duration 1 --trace fall.h5", declare_run},
    {"render", "Draw pictures or a movie of a trace or a scene",
     "mssim render --scene jeans4k --out jeans.png", declare_render},
    {"export", "Write frames of a trace as OBJ, PLY or VTKHDF for other programs",
     "mssim export fall.h5 --format vtkhdf --frames all", declare_export},
    {"guide", "Measure which integrator, backend and step a scene should be simulated with",
     "mssim guide --scene cloth10k --fps 60 --error 1e-3", declare_guide},
    {"check", "Check scene files: size, memory, time and stability limit, without a run",
     "mssim check my-cloth.json", declare_check},
    {"compare", "Compare two results or programs: which is faster, and is that certain?",
     "mssim compare results/yesterday results/today", declare_compare},
    {"history", "Keep the times of commits in a file, and find the commit that changed them",
     "mssim history add results/today --file history.jsonl", declare_history},
    {"report", "Write one HTML page about results: verdict, tables, charts, provenance",
     "mssim report results/table1 results/table3 --out report.html", declare_report},
    {"table", "Write tables, charts, methods and an artifact appendix for a paper in LaTeX",
     "mssim table results/table1/zen4 --format latex --out paper", declare_table},
    {"measure", "Measure a person's surface, and write a scene of jeans for it",
     "mssim measure scan.obj --scene my.json", declare_measure},
    {"web", "Write or serve a page that measures a phone's GPU in its browser",
     "mssim web --serve --results results/phone", declare_web},
    {"new-backend", "Write a backend of your own to start from, in Python or C++",
     "mssim new-backend mine --language python", declare_new_backend},
    {"doctor", "Check this machine: what mssim needs, what is missing, how to get it", "mssim doctor",
     declare_doctor},
    {"list", "List scenes, suites, backends, methods, integrators, devices or a schema",
     "mssim list scenes --format csv", declare_list},
    {"help", "Show this page, or the page of a command", "mssim help bench", declare_help},
});

constexpr std::string_view exit_codes =
    "Exit codes: 0 success; 1 a row is not verified, a simulation blew up, a garment\n"
    "does not fit, a guide had too little time or a program of it failed, a measured\n"
    "body takes no jeans, or a comparison or a history shows a regression; 2 bad\n"
    "usage or input; 3 a requested device or program is missing; 4 a file could not\n"
    "be written, or the system refused to read a trace.";

/// mssim's first argument when a shell asks what may stand in the place of the last of the words that follow
/// (src/completion).
constexpr std::string_view complete_word = "--complete";

/// A user may name a scene without --scene before it.
std::string option_of_scene(const std::string& word) { return is_scene(word) ? "--scene" : ""; }

int fail(int code, const std::string& sentence) {
  tell(escaped(sentence));  // names may contain control characters
  return code;
}

/// Why writing to standard output has failed. The stream does not keep the system's reason, and what has
/// happened since may have replaced errno, so it tries once more.
std::string lost_output() {
  std::cout.clear();
  errno = 0;
  std::cout << '\n' << std::flush;
  const std::string reason = errno != 0 ? fmt::format(" ({})", std::generic_category().message(errno)) : "";
  return "standard output could not be written" + reason +
         ": free some space, or redirect it to another file";
}

/// The standard library's message contains the name of a function.
std::string sentence_of(const std::filesystem::filesystem_error& error) {
  const std::string file = error.path1().string(), reason = " (" + error.code().message() + "): ";
  return file.empty() ? "the working folder cannot be found" + reason + "change into a folder that is there"
                      : file + " cannot be looked up" + reason + "check the path and its permissions";
}

/// Runs a command and returns the exit code for what it throws, after printing the message.
int run_guarded(const std::function<int()>& run) {
  try {
    return run();
  } catch (const Interrupted& interrupted) {
    remove_temporary_folder_of_process();
    std::signal(interrupted.signal, SIG_DFL);
    std::raise(interrupted.signal);
    return 128 + interrupted.signal;  // only if the signal is blocked
  } catch (const Error& error) {
    return fail(error.exit_code, error.what());
  } catch (const std::bad_alloc&) {
    return fail(exit_bad_input, "there is not enough memory; close other programs or use a smaller scene");
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(exit_file_error, sentence_of(error));
  } catch (const std::exception& error) {
    return fail(exit_file_error, error.what());
  }
}

}  // namespace

std::span<const Command> commands() { return table; }

std::string unknown_command(std::string_view name) {
  constexpr auto others = std::to_array<OtherName>({{"version", "--version"}});
  return unknown_name("command", name, mapped<std::string_view>(table, &Command::name), others) +
         "; see mssim --help";
}

int run_program(int argc, char** argv) {
  remember_arguments(argc, argv);
  if (argc > 1 && argv[1] == driver_trial_word)
    run_driver_trial({argv + 2, static_cast<std::size_t>(argc - 2)});
  if (argc > 1 && argv[1][0] != '-') {  // the parser would report an unexpected argument
    const std::string_view word = argv[1];
    if (std::ranges::find(commands(), word, &Command::name) == commands().end())
      return fail(exit_bad_input, unknown_command(word));
  }
  hear_of_slow_drivers([](const std::string& sentence) { tell(sentence); });
  const BuildInfo& build = build_info();
  ProgramParser parser(
      "mssim", fmt::format("mssim {}: benchmark harness for parallel mass-spring simulation", build.version),
      fmt::format("mssim {} ({}{})", build.version, build.commit, build.dirty ? ", changed" : ""));
  std::string examples;
  std::map<std::string, std::function<int()>> run;
  for (const Command& command : commands()) {
    const std::string name(command.name), example(command.example);
    Arguments arguments =
        parser.add_command(name, std::string(command.description), "Example:\n  " + example);
    run[name] = command.declare(arguments);
    examples += "\n  " + example;
  }
  parser.end_help_with(fmt::format(
      "mssim help COMMAND explains a command and its options.\n\nExamples:{}\n\n{}", examples, exit_codes));
  if (argc > 1 && argv[1] == complete_word)
    return run_guarded([&] {
      std::cout << parser.completions(std::vector<std::string>(argv + 2, argv + argc)) << std::flush;
      return exit_ok;
    });
  ProgramParser::Request request;
  const auto parse = [&] {  // which looks scenes up
    request = parser.parse(argc, argv, option_of_scene);
    return exit_ok;
  };
  if (const int failed = run_guarded(parse); failed != exit_ok) return failed;
  if (!request.refusal.empty()) return fail(exit_bad_input, request.refusal);
  int code = exit_ok;
  if (!request.page.empty()) {
    std::cout << request.page;
  } else if (request.command.empty()) {
    std::cerr << parser.help_page();
    return exit_bad_input;
  } else {
    code = run_guarded(run.at(request.command));
  }
  // Results that could not be written are lost (a full disk; a closed pipe ends the program by SIGPIPE).
  if (!std::cout.flush()) return fail(exit_file_error, lost_output());
  return code;
}

}  // namespace mssim
