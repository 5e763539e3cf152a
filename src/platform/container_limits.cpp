#include "platform/container_limits.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace mssim {
namespace {

namespace fs = std::filesystem;

/// Where the files of one kind of limit are in a group's folder, and what they are called.
struct Dialect {
  bool unified;  ///< version 2, whose groups have all controllers
  std::string_view quota, period, limit, used, file_prefix;
};
/// An empty name: version 2 has quota and period in one file.
constexpr Dialect version_1{
    false,   "cpu.cfs_quota_us", "cpu.cfs_period_us", "memory.limit_in_bytes", "memory.usage_in_bytes",
    "total_"};
constexpr Dialect version_2{true, "cpu.max", "", "memory.max", "memory.current", ""};

/// A folder of the file system where groups are mounted.
struct Mount {
  const Dialect* dialect;
  std::string controllers;  ///< of version 1, with a comma before and behind each
  std::string root;         ///< the group that its folder is
  fs::path folder;
};

/// The numbers at the start of a file; what is no number, such as "max", ends them.
std::vector<std::int64_t> numbers_in(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::int64_t> numbers;
  for (std::int64_t number = 0; in >> number;) numbers.push_back(number);
  return numbers;
}

/// Of /proc/self/mountinfo: "36 35 98:0 /root /folder options [more...] - cgroup source options".
std::vector<Mount> mounts(const fs::path& root) {
  std::vector<Mount> found;
  std::ifstream in(root / "proc/self/mountinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t dash = line.find(" - ");
    if (dash == std::string::npos) continue;
    std::istringstream before(line.substr(0, dash)), behind(line.substr(dash + 3));
    std::string skipped, group, folder, type, source, options;
    before >> skipped >> skipped >> skipped >> group >> folder;
    behind >> type >> source >> options;
    if (type == "cgroup" || type == "cgroup2")
      found.push_back({type == "cgroup" ? &version_1 : &version_2, ',' + options + ',', group,
                       root / fs::path(folder).relative_path()});
  }
  return found;
}

/// Of /proc/self/cgroup: "4:cpu,cpuacct:/group", of version 2 "0::/group". The group that this process is in,
/// of the hierarchy that is mounted there; a group beyond the mount's root cannot be seen, and is that.
fs::path own_group(const Mount& mount, const fs::path& root) {
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string_view any = std::string_view(controllers).substr(0, controllers.find(','));
    const bool same =
        mount.dialect->unified
            ? controllers.empty()
            : !any.empty() && mount.controllers.find(',' + std::string(any) + ',') != std::string::npos;
    if (!same) continue;
    std::string_view group = std::string_view(line).substr(second + 1);
    if (group.starts_with("/..")) return {};
    if (mount.root != "/") {
      if (!group.starts_with(mount.root)) return {};
      group.remove_prefix(mount.root.size());
    }
    return fs::path(group).relative_path();
  }
  return {};
}

template <class Number>
void take_least(std::optional<Number>& least, Number number) {
  least = std::min(least.value_or(number), number);
}

/// The kernel's copies of files in a group, which it gives up for memory that is asked for.
std::uint64_t file_bytes(const fs::path& statistics, std::string_view prefix) {
  std::ifstream in(statistics);
  std::uint64_t sum = 0, bytes = 0;
  for (std::string key; in >> key >> bytes;)
    if (key == std::string(prefix) + "inactive_file" || key == std::string(prefix) + "active_file")
      sum += bytes;
  return sum;
}

void add_group(ContainerLimits& limits, const Dialect& dialect, const fs::path& folder) {
  std::vector<std::int64_t> quota = numbers_in(folder / dialect.quota);
  if (!dialect.period.empty())
    for (const std::int64_t period : numbers_in(folder / dialect.period)) quota.push_back(period);
  if (quota.size() == 2 && quota[0] > 0 && quota[1] > 0)
    take_least(limits.processors, static_cast<double>(quota[0]) / static_cast<double>(quota[1]));

  // Version 1 says the largest number, less what does not fill a page, where there is no limit.
  constexpr std::int64_t none = std::int64_t{1} << 62;
  const std::vector<std::int64_t> limit = numbers_in(folder / dialect.limit);
  if (limit.empty() || limit[0] < 0 || limit[0] >= none) return;
  const auto bytes = static_cast<std::uint64_t>(limit[0]);
  take_least(limits.memory_bytes, bytes);
  const std::vector<std::int64_t> used = numbers_in(folder / dialect.used);
  const std::uint64_t in_use =
      used.empty() ? 0 : static_cast<std::uint64_t>(std::max<std::int64_t>(used[0], 0));
  const std::uint64_t files = std::min(in_use, file_bytes(folder / "memory.stat", dialect.file_prefix));
  take_least(limits.memory_left, bytes - std::min(bytes, in_use - files));
}

}  // namespace

ContainerLimits container_limits(const fs::path& root) {
  ContainerLimits limits;
  for (const Mount& mount : mounts(root)) {
    const fs::path group = own_group(mount, root);
    fs::path folder = mount.folder;
    add_group(limits, *mount.dialect, folder);
    for (const fs::path& name : group) add_group(limits, *mount.dialect, folder /= name);
  }
  return limits;
}

}  // namespace mssim
