#include "platform/supervised_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

#include "platform/machine.h"
#include "tests/support/files_fixture.h"
#include "tests/support/testing.h"

namespace mssim {
namespace {

/// Whether it becomes true soon; a machine may be busy.
bool soon(const std::function<bool()>& becomes_true) {
  for (int i = 0; i < 3000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(10)))
    if (becomes_true()) return true;
  return false;
}

/// A file of /proc; empty where its process is gone.
std::string proc_text(const std::string& name) {
  std::ifstream file("/proc/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A field of /proc/PROCESS/stat, counted from 3, which is the state, as its manual counts.
std::string stat_field(pid_t process, int field) {
  const std::string stat = proc_text(std::to_string(process) + "/stat");
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(stat.substr(name_end + 1));
  std::string word;
  for (int i = 3; i <= field; ++i) words >> word;
  return word;
}

/// By its command, because an emulator that runs it has another name.
bool is_supervisor(pid_t process) {
  return proc_text(std::to_string(process) + "/cmdline").find("supervise") != std::string::npos;
}

class SupervisedProcesses : public TemporaryFolderTest {
 protected:
  // What this process starts inherits the mark, the supervisor too.
  SupervisedProcesses() { setenv("MSSIM_TEST_MARK", folder().c_str(), 1); }
  ~SupervisedProcesses() override { unsetenv("MSSIM_TEST_MARK"); }

  /// A shell's process becomes the last program of its commands.
  SupervisedProgram shell(const std::string& commands) const {
    return {"/bin/sh", {"-c", commands}, {}, folder(), {}};
  }
  /// How a shell with these commands ends by itself.
  ProgramEnd end_of(const std::string& commands) const {
    SupervisedProcess process(shell(commands));
    return process.end(std::chrono::seconds(60));
  }

  /// The processes that are left of all that this test started; those that have ended and that nobody has
  /// waited for have no environment any more.
  std::vector<pid_t> processes() const {
    const std::string mark = "MSSIM_TEST_MARK=" + folder().string();
    std::vector<pid_t> marked;
    std::error_code error;
    for (std::filesystem::directory_iterator entry("/proc", error), end; entry != end; entry.increment(error))
      if (const std::string name = entry->path().filename();
          name.find_first_not_of("0123456789") == std::string::npos)
        if (proc_text(name + "/environ").find(mark) != std::string::npos) marked.push_back(std::stoi(name));
    return marked;
  }
  std::vector<pid_t> processes_of_program() const {
    std::vector<pid_t> all = processes();
    std::erase_if(all, is_supervisor);
    return all;
  }
  bool all_stopped(bool stopped) const {
    return soon([&] {
      return std::ranges::all_of(processes_of_program(),
                                 [&](pid_t one) { return (stat_field(one, 3) == "T") == stopped; });
    });
  }
  std::string failure(const SupervisedProgram& program) const {
    return sentence_of<std::runtime_error>([&] { const SupervisedProcess process(program); });
  }
};

using namespace std::chrono_literals;

TEST_F(SupervisedProcesses, EndByExitCodeOrBySignal) {
  const ProgramEnd code = end_of("echo one; echo two >&2; exit 3");
  EXPECT_EQ(code.exit_code, 3);
  EXPECT_EQ(code.signal, 0);
  EXPECT_EQ(code.output, "one\ntwo\n");
  EXPECT_EQ(describe(code), "ended with exit code 3");
  const ProgramEnd signal = end_of("echo one; kill -SEGV $$");
  EXPECT_EQ(signal.signal, SIGSEGV);
  EXPECT_EQ(signal.output, "one\n");
  EXPECT_EQ(describe(signal), "was ended by signal 11 (Segmentation fault)");
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedProcesses, TellByADescriptorThatTheyHaveEnded) {
  SupervisedProcess process(shell("until [ -e end ]; do sleep 0.01; done"));
  pollfd event{process.end_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&event, 1, 50), 0);
  put("end", "");
  EXPECT_EQ(::poll(&event, 1, 60'000), 1);
  const ProgramEnd& end = process.end(0s);
  EXPECT_EQ(describe(end), "ended with exit code 0");
  // From then on nothing changes.
  process.pause();
  process.resume();
  EXPECT_EQ(::poll(&event, 1, 0), 1);
  EXPECT_EQ(&process.end(60s), &end);
}

TEST_F(SupervisedProcesses, SayInOneSentenceThatTheyCannotBeStarted) {
  SupervisedProgram program = shell("");
  const auto failure_of = [&](const char* name, std::string_view text, bool executable) {
    program.program = name;
    if (!text.empty()) put(name, text);
    if (executable)
      std::filesystem::permissions(folder() / name, std::filesystem::perms::owner_exec,
                                   std::filesystem::perm_options::add);
    return failure(program);
  };
  EXPECT_EQ(failure_of("./missing", "", false), "cannot run ./missing: there is no such file");
  EXPECT_EQ(failure_of("./plain", "#!/bin/sh\n", false),
            "cannot run ./plain: it is not executable (chmod +x)");
  EXPECT_EQ(
      failure_of("./lost", "#! /no/such/python3 -u\n", true),
      "cannot run ./lost: its interpreter /no/such/python3 cannot be started (No such file or directory)");
  EXPECT_THAT(failure_of("./windows", "#!/bin/sh\r\n", true), HasSubstr("CR LF"));
  EXPECT_THAT(failure_of("./windows2", "#!/usr/bin/env sh\r\n", true), HasSubstr("CR LF"));  // env starts
  EXPECT_THAT(failure_of("./text", "print(1)\n", true),
              HasSubstr("neither a program for this machine nor a "));
  EXPECT_THAT(failure_of("./elf", "\177ELF", true), HasSubstr("neither a program for this machine nor a "));
  EXPECT_EQ(failure_of("/", "", false), "cannot run /: it is a folder");
  program = shell("");
  program.folder = folder() / "missing";
  EXPECT_EQ(failure(program), "cannot run /bin/sh: its folder " + program.folder.string() +
                                  " cannot be entered (No such file or directory)");
  program = shell("");
  program.cpus = {CPU_SETSIZE};
  EXPECT_EQ(failure(program), "cannot run /bin/sh: it cannot be bound to its CPUs (Invalid argument)");
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedProcesses, MayWriteWithoutEnd) {
  SupervisedProcess process(shell("head -c 300000000 /dev/zero; head -c 1000000 /dev/zero >&2; echo end"));
  long most_kib = 0;
  pollfd event{process.end_descriptor(), POLLIN, 0};
  while (::poll(&event, 1, 10) == 0)
    for (const pid_t one : processes())
      if (is_supervisor(one))
        most_kib = std::max(most_kib, std::stol(stat_field(one, 24)) * ::getpagesize() / 1024);
  const ProgramEnd& end = process.end(0s);
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_EQ(end.output.size(), kept_output_bytes);
  EXPECT_THAT(end.output, EndsWith(std::string(1, '\0') + "end\n"));
  EXPECT_GT(most_kib, 0);
  EXPECT_LT(most_kib, 32 * 1024);
}

TEST_F(SupervisedProcesses, ThatStopTheirSupervisorStillObey) {
  SupervisedProcess process(shell("kill -STOP $PPID; touch stopped; exec sleep 1000"));
  ASSERT_TRUE(soon([&] { return exists(folder() / "stopped"); }));
  process.pause();
  EXPECT_TRUE(all_stopped(true));
  EXPECT_EQ(describe(process.end(0s)), "was ended by signal 9 (Killed)");
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedProcesses, ThatIgnoreSignalsAreEnded) {
  SupervisedProcess process(shell("trap '' TERM INT HUP; echo ready; while :; do sleep 1000; done"));
  ASSERT_TRUE(soon([&] { return processes_of_program().size() == 2; }));
  const auto start = std::chrono::steady_clock::now();
  const ProgramEnd& end = process.end(100ms);
  EXPECT_GE(std::chrono::steady_clock::now() - start, 100ms);
  EXPECT_EQ(describe(end), "was ended by signal 9 (Killed)");
  EXPECT_EQ(end.output, "ready\n");
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedProcesses, EndWithTheirSupervisor) {
  for (const bool asked : {false, true}) {
    SupervisedProcess process(
        shell("until [ -e started ]; do sleep 0.01; done; kill -9 $PPID; sleep 1000 & sleep 1000"));
    put("started", "");
    if (asked) process.pause();
    EXPECT_EQ(describe(process.end(60s)),
              "was ended because mssim's program supervise, which monitors it, was ended");
    EXPECT_TRUE(soon([&] { return processes().empty(); }));
    std::filesystem::remove(folder() / "started");
  }
}

TEST_F(SupervisedProcesses, ThatArePausedMayStillEndByThemselves) {
  SupervisedProcess process(shell("sleep 0.1; exit 5"));
  process.pause();
  EXPECT_EQ(process.end(60s).exit_code, 5);
}

TEST_F(SupervisedProcesses, InheritNothingOfMssim) {
  const int kept_open = ::open("/dev/null", O_RDONLY);  // NOLINT(android-cloexec-open): that is the point
  sigset_t blocked, before;
  ::sigemptyset(&blocked);
  ::sigaddset(&blocked, SIGUSR1);
  ::pthread_sigmask(SIG_BLOCK, &blocked, &before);
  const auto handler = std::signal(SIGUSR2, SIG_IGN);
  const ProgramEnd end = end_of(
      "wc -c; ls /proc/self/fd | tr '\\n' ' '; ulimit -c; cat /proc/$$/stat; "
      "grep -E '^Sig(Blk|Ign)' /proc/self/status");
  std::signal(SIGUSR2, handler);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(kept_open);
  std::istringstream output(end.output);
  std::string standard_input, descriptors, stat;
  std::getline(output, standard_input);
  std::getline(output, descriptors);
  std::getline(output, stat);
  EXPECT_EQ(standard_input, "0");
  EXPECT_EQ(descriptors, "0 1 2 3 0");  // ls has opened one; and the size of a core file
  std::istringstream numbers(stat.substr(stat.rfind(')') + 1));
  std::string state, ignored;
  pid_t parent = 0, group = 0, session = 0, terminal = 0;
  numbers >> state >> parent >> group >> session >> terminal;
  EXPECT_EQ(group, std::stoi(stat));
  EXPECT_EQ(session, parent);  // the supervisor's, which has no terminal, whose keys would send signals
  EXPECT_EQ(terminal, 0);
  // Beyond 31 are signals of the C library's own, which posix_spawn ignores.
  for (const char* set : {"SigBlk:\t", "SigIgn:\t"}) {
    const std::size_t place = end.output.find(set);
    ASSERT_NE(place, std::string::npos);
    EXPECT_EQ(std::stoull(end.output.substr(place + 8), nullptr, 16) & 0x7fffffffU, 0U) << set;
  }
}

TEST_F(SupervisedProcesses, RunWithTheirEnvironmentInTheirFolder) {
  SupervisedProgram program = shell("echo \"$PWD $ADDED $MSSIM_TEST_MARK $#\"");
  program.environment = {"ADDED=a b", "MSSIM_TEST_MARK=replaced"};
  program.arguments.insert(program.arguments.end(), {"name", "", "two words"});
  SupervisedProcess process(program);
  EXPECT_EQ(process.end(60s).output, folder().string() + " a b replaced 2\n");
}

TEST_F(SupervisedProcesses, AreBoundToProcessors) {
  SupervisedProgram program = shell("grep Cpus_allowed_list /proc/self/status");
  program.cpus = {process_cpus().back()};
  SupervisedProcess process(program);
  EXPECT_EQ(process.end(60s).output, "Cpus_allowed_list:\t" + std::to_string(program.cpus[0]) + "\n");
}

TEST_F(SupervisedProcesses, MayBeStartedByManyThreads) {
  std::vector<std::thread> threads;
  std::vector<ProgramEnd> ends(32);
  for (std::size_t t = 0; t < 8; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = t; i < ends.size(); i += 8)
        ends[i] =
            end_of("head -c 200000 /dev/zero; echo " + std::to_string(i) + "; exit " + std::to_string(i));
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < ends.size(); ++i) {
    EXPECT_EQ(ends[i].exit_code, static_cast<int>(i));
    EXPECT_THAT(ends[i].output, EndsWith(std::string(1, '\0') + std::to_string(i) + "\n"));
  }
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedProcesses, CostNothingWhileTheyWait) {
  const SupervisedProcess process(shell("exec sleep 1000"));
  const auto wakings = [&] {
    std::string all;
    for (const pid_t one : processes()) {
      const std::string status = proc_text(std::to_string(one) + "/status");
      all += status.substr(std::min(status.find("voluntary_ctxt_switches"), status.size()));
    }
    return all;
  };
  ASSERT_TRUE(soon([&] {
    const std::vector<pid_t> program = processes_of_program(), all = processes();
    return program.size() == 1 && proc_text(std::to_string(program[0]) + "/comm") == "sleep\n" &&
           std::ranges::all_of(all, [](pid_t one) { return stat_field(one, 3) == "S"; });
  }));
  const std::string before = wakings();
  EXPECT_FALSE(before.empty());
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(wakings(), before);
}

/// With children that leave the group and become orphans.
class SupervisedFamilies : public SupervisedProcesses {
 protected:
  void SetUp() override {
    int is_subreaper = 0;
    if (::prctl(PR_GET_CHILD_SUBREAPER, &is_subreaper) != 0)
      GTEST_SKIP() << "this emulator has no subreapers";
  }
};

/// A child, a session of its own, and a daemon that nobody of the family is the parent of, which all keep the
/// output open.
constexpr const char* family =
    "sleep 1000 & setsid sleep 1000 & (setsid sh -c 'sleep 1000 & sleep 1000 & wait' &); ";
constexpr std::size_t family_size = 5;

TEST_F(SupervisedFamilies, LeaveNothingWhenTheyEnd) {
  const ProgramEnd end =
      end_of(std::string(family) + "until [ -e end ]; do sleep 0.01; touch end; done; exit 4");
  EXPECT_EQ(end.exit_code, 4);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, LeaveNothingWhenTheyAreEnded) {
  {
    const SupervisedProcess process(shell(std::string(family) + "wait"));
    EXPECT_TRUE(soon([&] { return processes_of_program().size() == family_size + 1; }));
  }
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, LeaveNothingThatForksAgainAndAgain) {
  // Each process of a chain starts the next one and ends; some leave the group.
  put("chain", "f() { f & }\nf\n");
  for (int i = 0; i < 5; ++i) {
    {
      const SupervisedProcess process(
          shell("sh ./chain & setsid sh ./chain & (setsid sh ./chain &); touch ready; sleep 1000"));
      EXPECT_TRUE(soon([&] { return exists(folder() / "ready"); }));
    }
    EXPECT_TRUE(processes().empty());
  }
}

TEST_F(SupervisedFamilies, AreGoneSoonAfterMssimWasKilled) {
  const pid_t mssim = ::fork();
  if (mssim == 0) {
    try {
      const SupervisedProcess process(shell(std::string(family) + "wait"));
      ::pause();
    } catch (const std::exception&) {
    }
    ::_exit(1);
  }
  EXPECT_TRUE(soon([&] { return processes_of_program().size() == family_size + 1; }));
  ::kill(mssim, SIGKILL);
  ::waitpid(mssim, nullptr, 0);
  EXPECT_TRUE(soon([&] { return processes().empty(); }));
}

TEST_F(SupervisedFamilies, LeaveNothingWhenTheirSupervisorIsToldToEnd) {
  const ProgramEnd end = end_of(std::string(family) + "kill -TERM $PPID; sleep 1000");
  EXPECT_EQ(end.signal, SIGKILL);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, StopAndGoOnWithAllThatTheyStarted) {
  SupervisedProcess process(shell(std::string(family) + "while :; do echo >>count; done"));
  ASSERT_TRUE(
      soon([&] { return processes_of_program().size() == family_size + 1 && exists(folder() / "count"); }));
  for (int i = 0; i < 2; ++i) {
    process.pause();
    EXPECT_TRUE(all_stopped(true));
    const auto count = file_size(folder() / "count");
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(file_size(folder() / "count"), count);
    process.resume();
    EXPECT_TRUE(all_stopped(false));
    EXPECT_TRUE(soon([&] { return file_size(folder() / "count") > count; }));
  }
  process.pause();
  EXPECT_EQ(process.end(0s).signal, SIGKILL);
  EXPECT_TRUE(processes().empty());
}

TEST_F(SupervisedFamilies, CountTheirProcessorTime) {
  // In a child that has been waited for, in an orphan that has ended, and in the program itself.
  const std::string work = "i=0; while [ $i -lt 200000 ]; do i=$((i + 1)); done; ";
  SupervisedProcess process(shell("(" + work + "); touch child; (setsid sh -c '" + work +
                                  "touch orphan' &); "
                                  "until [ -e go ]; do sleep 0.01; done; while :; do :; done"));
  ASSERT_TRUE(soon([&] { return exists(folder() / "child"); }));
  const double child = process.processor_seconds();
  EXPECT_GT(child, 0.02);
  ASSERT_TRUE(soon([&] { return exists(folder() / "orphan"); }));
  const double orphan = process.processor_seconds();
  EXPECT_GT(orphan, child + 0.3 * child);
  put("go", "");
  EXPECT_TRUE(soon([&] { return process.processor_seconds() > orphan + 0.2; }));
  const double before = process.processor_seconds();
  process.end(0s);
  EXPECT_GE(process.processor_seconds(), before);
  EXPECT_LT(process.processor_seconds(), before + 60);
}

TEST_F(SupervisedFamilies, AddThePeaksOfTheirMemory) {
  // 30 MB in a child that still runs, and 30 MB that the program had for a moment.
  const std::string fill = "x=$(head -c 30000000 /dev/zero | tr '\\0' x); x=; ";
  SupervisedProcess process(shell("(" + fill + "touch child; sleep 60) & " + fill + "touch ready; sleep 60"));
  ASSERT_TRUE(soon([&] { return exists(folder() / "child") && exists(folder() / "ready"); }));
  EXPECT_GT(process.peak_bytes(), 60'000'000U);
  EXPECT_LT(process.peak_bytes(), 300'000'000U);
  process.end(0s);
  EXPECT_EQ(process.peak_bytes(), std::nullopt);
}

}  // namespace
}  // namespace mssim
