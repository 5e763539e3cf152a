#include "backends/hybrid.h"

#include <omp.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <barrier>
#include <cstdint>
#include <exception>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "backends/host_lines.h"
#include "backends/opencl_buffer.h"
#include "backends/opencl_call.h"
#include "backends/opencl_device.h"
#include "backends/opencl_program.h"

namespace mssim {
namespace {

/// A node in one pair, as kernels/packed_springs.cl reads it.
struct NodeRecord {
  Vec3<float> position;  // m
  float padding_1 = 0;
  Vec3<float> velocity;  // m/s
  float padding_2 = 0;
};
static_assert(sizeof(NodeRecord) == 8 * sizeof(float));

/// The packed unit of Hong et al., Figure 6.
struct PackedSpring {
  cl_uint first, second;
  float rest_length;
};
static_assert(sizeof(PackedSpring) == 3 * 4);

struct ForceRecord {
  Vec3<float> force;  // N
  float padding;
};
static_assert(sizeof(ForceRecord) == 4 * sizeof(float));

/// Work-items of a group; every kind's springs are filled up to a multiple of it.
constexpr std::size_t group_size = 64;

/// The springs sorted by kind, so that one launch with one stiffness and damping serves each kind.
struct PackedSprings {
  struct Kind {
    std::size_t begin, count;  // in `units`, multiples of group_size
  };
  std::vector<PackedSpring> units;  // springs of one kind follow each other in the scene's order
  std::vector<Kind> kinds;          // [materials]
  /// Node i's springs are entries[first_entry[i]] to entries[first_entry[i + 1] - 1], ascending: 2 * unit,
  /// plus 1 where the node is the spring's second end and feels the opposite of the unit's force.
  std::vector<std::uint32_t> first_entry, entries;

  explicit PackedSprings(const System& system) : first_entry(system.nodes() + 1, 0) {
    for (std::uint32_t kind = 0; kind < system.materials.size(); ++kind) {
      const std::size_t begin = units.size();
      for (const Spring& spring : system.springs)
        if (spring.kind == kind) units.push_back({spring.first, spring.second, spring.rest_length});
      for (const PackedSpring& unit : std::span(units).subspan(begin)) {
        ++first_entry[unit.first + 1];
        ++first_entry[unit.second + 1];
      }
      // What fills up has no length and gives a force that is not a number, which nobody reads.
      while (units.size() % group_size != 0) units.push_back({0, 0, 0});
      kinds.push_back({begin, units.size() - begin});
    }
    if (units.empty()) units.resize(group_size);  // OpenCL has no empty buffers
    for (std::size_t node = 0; node < system.nodes(); ++node) first_entry[node + 1] += first_entry[node];
    entries.resize(2 * system.springs.size());
    std::vector<std::uint32_t> next(first_entry.begin(), first_entry.end() - 1);
    for (std::uint32_t unit = 0; unit < units.size(); ++unit) {
      if (units[unit].first == units[unit].second) continue;
      entries[next[units[unit].first]++] = 2 * unit;
      entries[next[units[unit].second]++] = 2 * unit + 1;
    }
  }
};

/// Throws Unsupported unless the device can hold all that.
void check_size(std::size_t nodes, std::size_t pairs, std::size_t springs, const OpenclDevice& device) {
  const auto megabytes = [](std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; };
  const std::uint64_t largest = std::max(nodes * sizeof(NodeRecord), springs * sizeof(ForceRecord));
  const std::uint64_t all =
      pairs * nodes * sizeof(NodeRecord) + springs * (sizeof(ForceRecord) + sizeof(PackedSpring));
  if (springs > std::numeric_limits<std::uint32_t>::max() / 2)
    throw Unsupported("the scene has " + std::to_string(springs) +
                      " springs, hybrid numbers at most 2147483647");
  if (largest > device.max_allocation_bytes)
    throw Unsupported("the scene needs an OpenCL buffer of " + megabytes(largest) + ", " + device.name +
                      " allocates at most " + megabytes(device.max_allocation_bytes) + " in one piece");
  if (all > device.global_memory_bytes)
    throw Unsupported("the scene needs " + megabytes(all) + " of OpenCL buffers, " + device.name + " has " +
                      megabytes(device.global_memory_bytes) + " in all");
}

/// Between calls the host owns all pairs; the device owns the gathered pair and the forces while it computes.
class Hybrid final : public Backend {
 public:
  Hybrid(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
         int threads)
      : integrator_(integrator),
        coefficients_(coefficients_of<float>(integrator, dt_s)),
        device_(device),
        threads_(threads),
        nodes_(system.nodes()),
        pinned_(nodes_, false),
        inverse_mass_(nodes_),
        viscous_damping_(static_cast<float>(system.viscous_damping)),
        gravity_(static_cast<float>(system.gravity)),
        floor_height_(static_cast<float>(system.floor.height)),
        restitution_(static_cast<float>(system.floor.restitution)),
        friction_(static_cast<float>(system.floor.friction)) {
    PackedSprings springs(system);
    // All forces are there before a node is written, so that pairs may share memory.
    std::vector<Pair> stored;
    for (std::size_t i = 0; i < pair_kinds; ++i)
      if (stores(integrator, static_cast<Pair>(i), Storage::in_place)) stored.push_back(static_cast<Pair>(i));
    check_size(nodes_, stored.size(), springs.units.size(), device);

    const cl::Device cl_device(device.id, true);
    context_ = cl::Context(cl_device);
    queue_ = cl::CommandQueue(context_, cl_device);
    springs_.emplace(context_, springs.units.size(), device.shares_host_memory);
    forces_.emplace(context_, springs.units.size(), device.shares_host_memory);
    const auto units = springs_->map(queue_, CL_MAP_WRITE);
    std::copy(springs.units.begin(), springs.units.end(), units.begin());
    springs_->unmap(queue_, units);
    first_entry_ = std::move(springs.first_entry);
    entries_ = std::move(springs.entries);
    for (std::size_t node = 0; node < nodes_; ++node)
      inverse_mass_[node] = static_cast<float>(1 / system.node_mass[node]);
    for (const std::uint32_t pin : system.pins) pinned_[pin] = true;
    for (const Pair pair : stored) {
      auto& buffer = pairs_[index(pair)];
      buffer.emplace(context_, nodes_, device.shares_host_memory);
      host_[index(pair)] = buffer->map(queue_, CL_MAP_READ | CL_MAP_WRITE);
      std::fill(host_[index(pair)].begin(), host_[index(pair)].end(), NodeRecord{});
    }

    const cl::Program program = build_program(context_, cl_device, packed_springs_program_text());
    for (std::size_t kind = 0; kind < springs.kinds.size(); ++kind)
      if (springs.kinds[kind].count > 0) add_launch(program, springs.kinds[kind], system.materials[kind]);

    // Drivers finish compiling at a kernel's first launch with a range.
    set_state(system.start);
    step(1);
    set_state(system.start);
  }

  void set_state(const State& state) override {
    const auto records = host_[present_];
    for (std::size_t node = 0; node < nodes_; ++node)
      records[node] = {vec3_cast<float>(state.position[node]), 0, vec3_cast<float>(state.velocity[node]), 0};
  }

  void step(int count) override {
    with_integrator(integrator_, [&]<std::size_t row>(std::integral_constant<std::size_t, row>) {
      take_steps<row>(count);
    });
  }

  State state() const override {
    State state;
    for (const NodeRecord& record : host_[present_]) {
      state.position.push_back(vec3_cast<double>(record.position));
      state.velocity.push_back(vec3_cast<double>(record.velocity));
    }
    return state;
  }

  std::string device() const override { return device_.name; }
  int threads() const override { return threads_; }
  bool runs_on_host() const override { return device_.type == OpenclDeviceType::cpu; }

 private:
  struct Launch {
    cl::Kernel kernel;
    std::size_t begin, count;
  };

  void add_launch(const cl::Program& program, const PackedSprings::Kind& kind,
                  const SpringMaterial& material) {
    cl::Kernel kernel(program, "packed_spring_forces");
    kernel.setArg(0, springs_->buffer());
    kernel.setArg(2, forces_->buffer());
    kernel.setArg(3, static_cast<float>(material.stiffness));
    kernel.setArg(4, static_cast<float>(material.damping));
    launches_.push_back({kernel, kind.begin, kind.count});
  }

  /// Where a pair's records are when the state lies at `present`: an index into pairs_ and host_.
  template <std::size_t row>
  static std::size_t place_of(Pair pair, std::size_t present) {
    const Pair stored = storage_of(integrators[row], pair, Storage::in_place);
    if (stored == Pair::state) return present;
    if (stored == Pair::next) return index(Pair::state) + index(Pair::next) - present;
    return index(stored);
  }

  /// Lets the device compute all spring forces of a pair, and waits for them.
  void compute_forces(std::size_t place) {
    if (launches_.empty()) return;
    const auto& pair = *pairs_[place];
    if (!host_forces_.empty()) forces_->unmap(queue_, host_forces_);
    pair.unmap(queue_, host_[place]);
    for (Launch& launch : launches_) {
      launch.kernel.setArg(1, pair.buffer());
      queue_.enqueueNDRangeKernel(launch.kernel, cl::NDRange(launch.begin), cl::NDRange(launch.count),
                                  cl::NDRange(group_size));
    }
    host_forces_ = forces_->map(queue_, CL_MAP_READ, false);
    host_[place] = pair.map(queue_, CL_MAP_READ | CL_MAP_WRITE);
  }

  /// Sums the forces at the nodes [begin, end) and runs the lines of the stage.
  template <std::size_t row, std::size_t stage>
  void integrate(std::size_t begin, std::size_t end, std::size_t present) {
    constexpr Pair gather = integrators[row].stages[stage].gather;
    std::array<NodeRecord*, pair_kinds> pairs{};
    for (std::size_t i = 0; i < pair_kinds; ++i)
      pairs[i] = host_[place_of<row>(static_cast<Pair>(i), present)].data();
    for (std::size_t node = begin; node < end; ++node) {
      const auto record = [&]<Slot slot>(std::integral_constant<Slot, slot>) -> Vec3<float>& {
        NodeRecord& found = pairs[index(slot) / 2][node];
        return index(slot) % 2 == 0 ? found.position : found.velocity;
      };
      const Vec3<float> x = pairs[index(gather)][node].position, v = pairs[index(gather)][node].velocity;
      const bool pinned = pinned_[node] != 0;
      Vec3<float> a{};
      if (!pinned) {
        Vec3<float> force{};
        for (std::uint32_t i = first_entry_[node]; i < first_entry_[node + 1]; ++i) {
          const Vec3<float>& of_spring = host_forces_[entries_[i] / 2].force;
          if (entries_[i] % 2 == 0)
            force += of_spring;
          else
            force -= of_spring;
        }
        a = mul_add(-viscous_damping_, v, inverse_mass_[node] * force);
        a.y -= gravity_;
      }
      update_stage<row, stage>(
          coefficients_, x, v, a, record,
          [&]<Slot slot>(std::integral_constant<Slot, slot> which, const Vec3<float>& value) {
            record(which) = value;
          },
          [&](Vec3<float>& next_x, Vec3<float>& next_v) {
            if (!pinned) touch_floor(next_x, next_v, floor_height_, restitution_, friction_);
          });
    }
  }

  /// One parallel region for all steps. Its threads sleep at the gate while the device computes: a device on
  /// the same cores needs them, and threads that wait at OpenMP's own barriers spin for milliseconds.
  template <std::size_t row>
  void take_steps(int count) {
    std::optional<std::barrier<>> gate;
    std::exception_ptr failure;  // written by the first thread before the first gate, read between the two
    std::size_t last_present = present_;
#pragma omp parallel num_threads(threads_)
    {
#pragma omp single
      gate.emplace(omp_get_num_threads());
      const auto thread = static_cast<std::size_t>(omp_get_thread_num());
      const auto threads = static_cast<std::size_t>(omp_get_num_threads());
      const std::size_t begin = nodes_ * thread / threads, end = nodes_ * (thread + 1) / threads;
      std::size_t present = present_;
      for (int i = 0; i < count; ++i) {
        for_each_stage<row>([&]<std::size_t stage>(std::integral_constant<std::size_t, stage>) {
          if (thread == 0 && !failure) {
            try {
              compute_forces(place_of<row>(integrators[row].stages[stage].gather, present));
            } catch (...) {
              failure = std::current_exception();
            }
          }
          gate->arrive_and_wait();
          if (!failure) integrate<row, stage>(begin, end, present);
          gate->arrive_and_wait();
        });
        present = place_of<row>(Pair::next, present);
      }
      if (thread == 0) last_present = present;
    }
    present_ = last_present;
    if (failure) opencl_call<std::runtime_error>([&] { std::rethrow_exception(failure); });
  }

  const Integrator& integrator_;
  Coefficients<float> coefficients_;
  OpenclDevice device_;
  int threads_;
  std::size_t nodes_;
  std::vector<std::uint32_t> first_entry_, entries_;  // see PackedSprings
  std::vector<std::uint8_t> pinned_;                  // [nodes]
  std::vector<float> inverse_mass_;                   // [nodes] 1/kg
  float viscous_damping_, gravity_, floor_height_, restitution_, friction_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::array<std::optional<OpenclBuffer<NodeRecord>>, pair_kinds> pairs_;  // [Pair], those that are stored
  std::array<std::span<NodeRecord>, pair_kinds> host_;                     // [Pair], as mapped
  std::optional<OpenclBuffer<PackedSpring>> springs_;
  std::optional<OpenclBuffer<ForceRecord>> forces_;
  std::span<ForceRecord> host_forces_;  // as mapped; empty before the first step
  std::vector<Launch> launches_;        // by kind of spring
  std::size_t present_ = index(Pair::state);
};

}  // namespace

std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  if (options.threads < 1)
    throw std::invalid_argument("hybrid needs at least one host thread, not " +
                                std::to_string(options.threads));
  const OpenclDevice device = choose_opencl_device(opencl_devices(), options.device);
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    return std::make_unique<Hybrid>(system, integrator, dt_s, device, options.threads);
  });
}

}  // namespace mssim
