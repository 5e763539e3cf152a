#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "platform/supervised_process.h"
#include "tests/support/temporary_folder.h"

namespace mssim {

/// Whether it becomes true soon; a machine may be busy.
inline bool soon(const std::function<bool()>& becomes_true) {
  for (int i = 0; i < 3000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(10)))
    if (becomes_true()) return true;
  return false;
}

/// A file of /proc; empty where its process is gone.
inline std::string proc_text(const std::string& name) {
  std::ifstream file("/proc/" + name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A field of /proc/PROCESS/stat, counted from 3, which is the state, as its manual counts.
inline std::string stat_field(pid_t process, int field) {
  const std::string stat = proc_text(std::to_string(process) + "/stat");
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream words(stat.substr(name_end + 1));
  std::string word;
  for (int i = 3; i <= field; ++i) words >> word;
  return word;
}

/// By its command, because an emulator that runs it has another name.
inline bool is_supervisor(pid_t process) {
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
          name.find_first_not_of("0123456789") == name.npos)
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
    try {
      const SupervisedProcess process(program);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "it was started";
  }
};

}  // namespace mssim
