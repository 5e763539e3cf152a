#include "backends/process/program_start.h"

#include <cstdlib>

#include "backends/process/process_backend.h"
#include "platform/files.h"
#include "platform/machine.h"

namespace mssim {

std::vector<std::string> environment_of(const BackendProgram& program, const std::string& socket,
                                        const Integrator& integrator, const ExecutionOptions& options) {
  const char* path = std::getenv("PYTHONPATH");
  const std::string count = std::to_string(processors_of(program, options));
  std::vector<std::string> all{
      "MSSIM_SOCKET=" + socket, "MSSIM_THREADS=" + count, "OMP_NUM_THREADS=" + count,
      "PYTHONPATH=" + (data_folder() / "python").string() + (path && *path ? std::string(":") + path : "")};
  if (program.in_ranks) {
    all.push_back("MSSIM_RANKS=" + std::to_string(ranks_of(program, options).ranks));
    all.push_back("MSSIM_LAUNCHER=" + options.launcher);
    all.push_back("MSSIM_FOLDER=" + std::filesystem::current_path().string());
    all.push_back("MSSIM_INTEGRATOR=" + std::string(integrator.name));
    all.push_back("MSSIM_SCENE_FILE=" + std::filesystem::absolute(options.scene_file).string());
    all.push_back(std::string("MSSIM_ROOTS=") + (options.roots == Roots::exact ? "exact" : "fast"));
  }
  all.insert(all.end(), program.environment.begin(), program.environment.end());
  return all;
}

std::vector<int> first_cpus(int threads) {
  std::vector<int> cpus = process_cpus();
  if (cpus.size() <= static_cast<std::size_t>(threads)) return {};
  cpus.resize(static_cast<std::size_t>(threads));
  return cpus;
}

}  // namespace mssim
