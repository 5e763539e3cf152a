#include "backends/hybrid.h"

#include <omp.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "backends/chunk_tickets.h"
#include "backends/host_lines.h"
#include "backends/opencl/buffer.h"
#include "backends/opencl/call.h"
#include "backends/opencl/device.h"
#include "backends/opencl/lots.h"
#include "backends/opencl/program.h"
#include "backends/packed_springs.h"
#include "backends/quad.h"
#include "backends/surroundings.h"

namespace mssim {
namespace {

/// A node in one pair, as kernels/records.h reads it.
struct NodeRecord {
  Quad position;  // m
  Quad velocity;  // m/s
};
static_assert(sizeof(NodeRecord) == 8 * sizeof(float));

struct Material {
  float stiffness;  // N/m
  float damping;    // N s/m
};

/// Between calls the host owns all pairs; the device owns the gathered pair and the forces while it computes.
class Hybrid final : public Backend {
 public:
  Hybrid(const System& system, const Integrator& integrator, double dt_s, const OpenclDevice& device,
         int threads, int lanes, DeviceMemory memory)
      : integrator_(integrator),
        coefficients_(coefficients_of<float>(integrator, dt_s)),
        device_(device),
        memory_(memory),
        threads_(threads),
        packed_(system),
        held_(packed_.places(), true),
        inverse_mass_(packed_.places(), 0.0F),
        surroundings_(surroundings_of(system)),
        lots_(packed_.unit_count() / static_cast<std::size_t>(lanes), device, lanes) {
    // All forces are there before a node is written, so that pairs may share memory.
    const std::vector<Pair> stored = stored_pairs(integrator, Storage::in_place);
    const std::size_t forces = packed_.unit_count() + 1;
    std::vector<std::uint64_t> buffers(stored.size(), packed_.places() * sizeof(NodeRecord));
    buffers.insert(buffers.end(), {packed_.units.size() * sizeof(cl_uint), forces * sizeof(Quad)});
    require_memory(device, buffers);

    for (std::size_t node = 0; node < system.nodes(); ++node) {
      held_[packed_.place[node]] = false;
      inverse_mass_[packed_.place[node]] = static_cast<float>(1 / system.node_mass[node]);
    }
    for (const std::uint32_t pin : system.pins) held_[packed_.place[pin]] = true;

    const cl::Device cl_device(device.id, true);
    context_ = cl::Context(cl_device);
    queue_ = cl::CommandQueue(context_, cl_device);
    for (const Pair pair : stored) {
      auto& buffer = pairs_[index(pair)];
      buffer.emplace(context_, device_, memory_, packed_.places());
      host_[index(pair)] = buffer->map(queue_, CL_MAP_WRITE);
      std::fill(host_[index(pair)].begin(), host_[index(pair)].end(), NodeRecord{});
    }
    forces_.emplace(filled_buffer(std::vector<Quad>(forces)));  // the last one stays zero
    host_forces_ = forces_->map(queue_, CL_MAP_READ);
    if (!packed_.units.empty()) make_kernel(system, cl_device, lanes);
    packed_.units = {};

    // Drivers finish compiling at a kernel's first launch with a range.
    set_state(system.start);
    step(1);
    set_state(system.start);
  }

  void set_state(const State& state) override {
    const auto records = host_[present_];
    for (std::size_t node = 0; node < packed_.place.size(); ++node)
      records[packed_.place[node]] = {quad_of(vec3_cast<float>(state.position[node])),
                                      quad_of(vec3_cast<float>(state.velocity[node]))};
  }

  void step(int count) override {
    with_integrator(integrator_, [&]<std::size_t row>(std::integral_constant<std::size_t, row>) {
      constexpr int most = 1 << 20;  // a ticket numbers a call's phases
      static_assert(most * integrators[row].stage_count <= ChunkTickets::most_phases);
      for (; count > most; count -= most) take_steps<row>(most);
      take_steps<row>(count);
    });
  }

  State state() const override {
    State state;
    for (const std::uint32_t place : packed_.place) {
      const NodeRecord& record = host_[present_][place];
      state.position.push_back(vec3_cast<double>(vec3_of(record.position)));
      state.velocity.push_back(vec3_cast<double>(vec3_of(record.velocity)));
    }
    return state;
  }

  std::string device() const override { return label_of(device_, memory_); }
  int threads() const override { return threads_; }
  bool runs_on_host() const override { return device_.type == OpenclDeviceType::cpu; }

 private:
  template <class T>
  OpenclBuffer<T> filled_buffer(const std::vector<T>& values) const {
    OpenclBuffer<T> buffer(context_, device_, memory_, values.size());
    const auto mapped = buffer.map(queue_, CL_MAP_WRITE);
    std::copy(values.begin(), values.end(), mapped.begin());
    buffer.unmap(queue_, mapped, CL_MAP_WRITE);
    queue_.finish();
    return buffer;
  }

  /// Slices that a thread integrates between two looks at what is left: 64, unless those were too many
  /// chunks.
  std::size_t chunk_slices() const {
    return std::max<std::size_t>(64, packed_.slices() / ChunkTickets::most_chunks + 1);
  }

  void make_kernel(const System& system, const cl::Device& cl_device, int lanes) {
    std::vector<Material> materials;
    for (const SpringMaterial& material : system.materials)
      materials.push_back({static_cast<float>(material.stiffness), static_cast<float>(material.damping)});
    units_ = filled_buffer(packed_.units);
    kinds_ = filled_buffer(packed_.kinds);
    materials_ = filled_buffer(materials);
    kernel_.emplace(build_program(context_, cl_device, packed_springs_program_text(lanes)),
                    "packed_spring_forces");
    kernel_->setArg(0, units_->buffer());
    kernel_->setArg(2, forces_->buffer());
    kernel_->setArg(3, kinds_->buffer());
    kernel_->setArg(4, materials_->buffer());
    kernel_->setArg(5, static_cast<cl_uint>(packed_.unit_count()));
    kernel_->setArg(6, static_cast<cl_uint>(lots_.per_item));
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
    if (!kernel_) return;
    const auto& pair = *pairs_[place];
    forces_->unmap(queue_, host_forces_, CL_MAP_READ);
    pair.unmap(queue_, host_[place], CL_MAP_WRITE);
    kernel_->setArg(1, pair.buffer());
    queue_.enqueueNDRangeKernel(*kernel_, cl::NullRange, cl::NDRange(lots_.global), cl::NDRange(lots_.local));
    host_[place] = pair.map(queue_, CL_MAP_WRITE, false);
    host_forces_ = forces_->map(queue_, CL_MAP_READ);
  }

  /// The spring forces on the nodes of a slice, N.
  std::array<Quad, PackedSprings::slice_nodes> sum_forces(std::size_t slice) const {
    std::array<Quad, PackedSprings::slice_nodes> sums{};
    const Quad* forces = host_forces_.data();
    const auto entry_at = [&](std::size_t bound) {
      return packed_.entries.data() + packed_.first_entry[bound] * sums.size();
    };
    const std::uint32_t *entry = entry_at(2 * slice), *subtracted = entry_at(2 * slice + 1),
                        *end = entry_at(2 * slice + 2);
    for (; entry != subtracted; entry += sums.size())
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sums[i] + forces[entry[i]];
    for (; entry != end; entry += sums.size())
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = sums[i] - forces[entry[i]];
    return sums;
  }

  /// Sums the forces at the nodes of the slices [begin, end) and runs the lines of the stage.
  template <std::size_t row, std::size_t stage>
  void integrate(std::size_t begin, std::size_t end, std::size_t present) {
    constexpr Pair gather = integrators[row].stages[stage].gather;
    std::array<NodeRecord*, pair_kinds> pairs{};
    for (std::size_t i = 0; i < pair_kinds; ++i)
      pairs[i] = host_[place_of<row>(static_cast<Pair>(i), present)].data();
    // Copies, because the compiler must take every node written for a change of the members.
    const Coefficients<float> coefficients = coefficients_;
    const Surroundings around = surroundings_;
    const Quad gravity = quad_of({0, around.gravity, 0});
    const std::uint8_t* held = held_.data();
    const float* inverse_mass = inverse_mass_.data();
    for (std::size_t slice = begin; slice < end; ++slice) {
      const auto forces = sum_forces(slice);
      for (std::size_t i = 0; i < forces.size(); ++i) {
        const std::size_t node = slice * forces.size() + i;
        const auto record = [&]<Slot slot>(std::integral_constant<Slot, slot>) -> Quad& {
          NodeRecord& found = pairs[index(slot) / 2][node];
          return index(slot) % 2 == 0 ? found.position : found.velocity;
        };
        const Quad x = pairs[index(gather)][node].position, v = pairs[index(gather)][node].velocity;
        const bool free = held[node] == 0;
        const Quad a =
            free ? mul_add(-around.viscous_damping, v, inverse_mass[node] * forces[i]) - gravity : Quad{};
        update_stage<row, stage>(
            coefficients, x, v, a, record,
            [&]<Slot slot>(std::integral_constant<Slot, slot> which, const Quad& value) {
              record(which) = value;
            },
            [&](Quad& next_x, Quad& next_v) {
              if (!free || !(next_x.lanes[1] < around.floor_height)) return;
              Vec3<float> on_floor = vec3_of(next_x), bounced = vec3_of(next_v);
              touch_floor(on_floor, bounced, around.floor_height, around.restitution, around.friction);
              next_x = quad_of(on_floor);
              next_v = quad_of(bounced);
            });
      }
    }
  }

  /// Integrates the nodes of one chunk of slices in the stage that the ticket's phase stands for.
  template <std::size_t row>
  void work_on(const ChunkTickets::Ticket& ticket) {
    constexpr std::size_t stages = integrators[row].stage_count;
    const std::size_t begin = ticket.chunk * chunk_slices();
    const std::size_t end = std::min(begin + chunk_slices(), packed_.slices());
    for_each_stage<row>([&]<std::size_t stage>(std::integral_constant<std::size_t, stage>) {
      if (ticket.phase % stages == stage)
        integrate<row, stage>(begin, end, present_at<row>(ticket.phase / stages));
    });
  }

  /// Where the state lies before the call's step number `step`.
  template <std::size_t row>
  std::size_t present_at(std::size_t step) const {
    return step % 2 == 0 ? present_ : place_of<row>(Pair::next, present_);
  }

  /// One parallel region for all steps. Thread 0 drives the device; a phase is what the host does in a stage.
  template <std::size_t row>
  void take_steps(int count) {
    constexpr std::size_t stages = integrators[row].stage_count;
    ChunkTickets tickets(
        static_cast<std::uint32_t>((packed_.slices() + chunk_slices() - 1) / chunk_slices()));
    const auto act = [&](const ChunkTickets::Ticket& ticket) { work_on<row>(ticket); };
    std::exception_ptr failure;  // of thread 0; none may leave the region
#pragma omp parallel num_threads(threads_)
    {
      if (omp_get_thread_num() == 0) {
        try {
          for (std::size_t phase = 0; phase < static_cast<std::size_t>(count) * stages; ++phase) {
            compute_forces(place_of<row>(integrators[row].stages[phase % stages].gather,
                                         present_at<row>(phase / stages)));
            tickets.open();
            tickets.work(0, act);
            tickets.wait_until_finished();
          }
        } catch (...) {
          failure = std::current_exception();
        }
        tickets.close();
      } else {
        tickets.work_until_closed(0, 0, act, [] {});  // a device on the same cores: no spinning
      }
    }
    present_ = present_at<row>(static_cast<std::size_t>(count));
    if (failure) opencl_call<std::runtime_error>([&] { std::rethrow_exception(failure); });
  }

  const Integrator& integrator_;
  Coefficients<float> coefficients_;
  OpenclDevice device_;
  DeviceMemory memory_;
  int threads_;
  PackedSprings packed_;
  std::vector<std::uint8_t> held_;   // [places] pinned, or no node
  std::vector<float> inverse_mass_;  // [places] 1/kg
  Surroundings surroundings_;
  OpenclLots lots_;  // of units
  cl::Context context_;
  cl::CommandQueue queue_;
  std::array<std::optional<OpenclBuffer<NodeRecord>>, pair_kinds> pairs_;  // [Pair], those that are stored
  std::array<std::span<NodeRecord>, pair_kinds> host_;                     // [Pair], as mapped
  std::optional<OpenclBuffer<Quad>> forces_;                               // [units + 1], the last one zero
  std::span<Quad> host_forces_;                                            // as mapped
  std::optional<OpenclBuffer<cl_uint>> units_, kinds_;
  std::optional<OpenclBuffer<Material>> materials_;
  std::optional<cl::Kernel> kernel_;  // none without springs
  std::size_t present_ = index(Pair::state);
};

}  // namespace

std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int threads, int lanes,
                                     DeviceMemory memory) {
  if (threads < 1)
    throw std::invalid_argument("hybrid needs at least one host thread, not " + std::to_string(threads));
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    return std::make_unique<Hybrid>(system, integrator, dt_s, device, threads, lanes, memory);
  });
}

std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = choose_opencl_device(opencl_devices(), options.device);
  return make_hybrid(system, integrator, dt_s, device, options.threads, lanes_for(device), options.memory);
}

}  // namespace mssim
