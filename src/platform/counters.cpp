#include "platform/counters.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "text/text.h"

namespace mssim {
namespace {

namespace fs = std::filesystem;

std::optional<double> number_in(const fs::path& file) {
  std::ifstream in(file);
  double number = 0;
  return in >> number ? std::optional(number) : std::nullopt;
}

/// Why events cannot be counted, from perf_event_open's errno.
std::string event_obstacle(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case EOPNOTSUPP:
      return "the system offers no counters of the processor's events: use a machine that is not virtual";
    case EACCES:
    case EPERM:
    case ENOSYS:
      return "the system does not let this user count events: lower kernel.perf_event_paranoid to 2 "
             "(sysctl), or let the container call perf_event_open";
    default:
      return fmt::format("the processor's events cannot be counted: {}",
                         std::generic_category().message(error));
  }
}

}  // namespace

PackageEnergy::PackageEnergy(const fs::path& root) {
  const fs::path folder = root / "sys/class/powercap";
  obstacle_ =
      "the system has no energy counters in " + folder.string() + ": use a machine that is not virtual";
  std::error_code error;
  for (const fs::directory_entry& zone : fs::directory_iterator(folder, error)) {
    std::string name;  // others are parts of a package, the whole machine, or the same by another way
    if (!zone.path().filename().string().starts_with("intel-rapl:") ||
        !(std::ifstream(zone.path() / "name") >> name) || !name.starts_with("package-"))
      continue;
    const std::optional<double> range = number_in(zone.path() / "max_energy_range_uj"),
                                now = number_in(zone.path() / "energy_uj");
    if (!range || !now) {
      obstacle_ = "the energy counter " + (zone.path() / "energy_uj").string() +
                  " cannot be read: let its owner allow it (chmod a+r)";
      counters_.clear();
      return;
    }
    counters_.push_back({zone.path() / "energy_uj", *range, *now});
  }
  if (!counters_.empty()) obstacle_.clear();
}

std::optional<double> PackageEnergy::joules() {
  // All are read before one is stored, so that their intervals stay alike if one cannot be read.
  std::vector<double> all_uj;
  for (const Counter& counter : counters_) {
    const std::optional<double> now = number_in(counter.file);
    if (!now) return std::nullopt;
    all_uj.push_back(*now);
  }
  double sum_uj = 0;
  for (std::size_t i = 0; i < counters_.size(); ++i) {
    Counter& counter = counters_[i];
    const double last_uj = std::exchange(counter.last_uj, all_uj[i]);
    sum_uj += counter.last_uj - last_uj + (counter.last_uj < last_uj ? counter.range_uj : 0);
  }
  return counters_.empty() ? std::nullopt : std::optional(1e-6 * sum_uj);
}

const EventCounters::Events EventCounters::of_processor{{{PERF_TYPE_HARDWARE, PERF_COUNT_HW_CPU_CYCLES},
                                                         {PERF_TYPE_HARDWARE, PERF_COUNT_HW_INSTRUCTIONS},
                                                         {PERF_TYPE_HARDWARE, PERF_COUNT_HW_CACHE_MISSES}}};

EventCounters::EventCounters(const Events& events) : events_(events) {
  if (const int error = open(0); error != 0) obstacle_ = event_obstacle(error);
  descriptors_.clear();
}

int EventCounters::open(int thread) {
  for (const CountedEvent& event : events_) {
    perf_event_attr attributes{};
    attributes.size = sizeof attributes;
    attributes.type = event.type;
    attributes.config = event.config;
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    attributes.disabled = 1;
    attributes.inherit = 1;
    // Without privileges, the kernel's events cannot be counted.
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    const long descriptor = ::syscall(SYS_perf_event_open, &attributes, thread, -1, -1, PERF_FLAG_FD_CLOEXEC);
    if (descriptor < 0) {
      const int error = errno;
      descriptors_.resize(descriptors_.size() / count * count);
      return error;
    }
    descriptors_.emplace_back(static_cast<int>(descriptor));
  }
  return 0;
}

void EventCounters::start() {
  descriptors_.clear();
  if (!obstacle_.empty()) return;
  std::error_code error;
  for (const fs::directory_entry& thread : fs::directory_iterator("/proc/self/task", error)) {
    const int failure = open(std::stoi(thread.path().filename().string()));
    // A thread can have ended by now. Without one that runs, the sum would be too small.
    if (failure != 0 && failure != ESRCH) return descriptors_.clear();
  }
  for (const Descriptor& descriptor : descriptors_) ::ioctl(descriptor.get(), PERF_EVENT_IOC_ENABLE, 0);
}

std::optional<std::array<double, EventCounters::count>> EventCounters::stop() {
  for (const Descriptor& descriptor : descriptors_) ::ioctl(descriptor.get(), PERF_EVENT_IOC_DISABLE, 0);
  const std::vector<Descriptor> descriptors = std::exchange(descriptors_, {});
  if (descriptors.empty()) return std::nullopt;
  std::array<double, count> sums{};
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    struct {
      std::uint64_t events, enabled_ns, counted_ns;
    } reading{};
    if (::read(descriptors[i].get(), &reading, sizeof reading) != sizeof reading) return std::nullopt;
    if (reading.enabled_ns == 0) continue;  // the thread slept
    if (reading.counted_ns == 0) return std::nullopt;
    sums[i % count] += static_cast<double>(reading.events) * static_cast<double>(reading.enabled_ns) /
                       static_cast<double>(reading.counted_ns);
  }
  return sums;
}

}  // namespace mssim
