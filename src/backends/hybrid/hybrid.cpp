#include "backends/hybrid/hybrid.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "backends/devices/device_queue.h"
#include "backends/hybrid/integrate_nodes.h"
#include "backends/threads/chunk_tickets.h"

namespace mssim {

HostNodes::HostNodes(const System& system, const Integrator& method, double dt_s)
    : ExplicitSteps<float>(system, method, dt_s),
      packed(system),
      constants(packed.slots() * 2),
      materials(materials_of<float>(system)) {
  constexpr std::size_t slice_nodes = PackedSprings::slice_nodes;
  const auto of_slot = [&](std::size_t slot) { return constants.data() + slot_offset(slot, 2, slice_nodes); };
  for (std::size_t slot = 0; slot < packed.slots(); ++slot) of_slot(slot)[slice_nodes] = 1;
  for (std::size_t node = 0; node < system.nodes(); ++node) {
    of_slot(packed.slot[node])[0] = static_cast<float>(1 / system.node_mass[node]);
    of_slot(packed.slot[node])[slice_nodes] = 0;
  }
  for (const std::uint32_t pin : system.pins) of_slot(packed.slot[pin])[slice_nodes] = 1;
}

SpringKernel HostNodes::spring_kernel(int lanes) const {
  const std::size_t units_of_part = lanes == 1 ? 1 : PackedSprings::slice_nodes;
  return {program_text(lanes,
                       {"lanes.h", "records.h", "spring_constants.h", "spring_law.h", "packed_springs.cl"}),
          "packed_spring_forces",
          packed.unit_count() / units_of_part,
          packed.slots() * record_floats,
          4 * (packed.unit_count() + 1),  // with a zero force after those of the units
          {std::as_bytes(std::span(packed.units)), std::as_bytes(std::span(packed.entries)),
           std::as_bytes(std::span(materials))}};
}

void HostNodes::forget_units() {
  packed.units = {};
  packed.entries = {};
}

AlikeNodes::AlikeNodes(const System& system, const std::vector<AlikeBodies>& bodies, const Integrator& method,
                       double dt_s)
    : ExplicitSteps<float>(system, method, dt_s), springs(bodies) {}

SpringKernel AlikeNodes::spring_kernel(int lanes) const {
  const std::size_t parts = AlikeSprings::slice_nodes / static_cast<std::size_t>(lanes);
  return {slices_program_text(AlikeSprings::slice_nodes, lanes,
                              {"lanes.h", "spring_constants.h", "spring_law.h", "alike_springs.cl"}),
          "alike_spring_forces",
          springs.springs.size() * parts,
          springs.slices.floats(),
          springs.springs.size() * 3 * AlikeSprings::slice_nodes,
          {std::as_bytes(std::span(springs.springs)), std::as_bytes(std::span(springs.shapes))}};
}

namespace {

/// Data of `hybrid` on the device: the springs permanently; the nodes and forces in memory that it shares in
/// turn with the host. Between calls the host has them.
class SpringDevice {
 public:
  /// `lanes`: those of the kernel's text. `stored`: the pairs that the integrator needs; they and the forces
  /// are zero. Throws Unsupported if the data does not fit into the device's memory, and cl::Error.
  SpringDevice(const SpringKernel& spring_kernel, const std::vector<Pair>& stored, const OpenclDevice& device,
               int lanes, DeviceMemory memory)
      : queue_(device, memory) {
    std::vector<std::uint64_t> buffers(stored.size(), spring_kernel.pair_floats * sizeof(float));
    for (const std::span<const std::byte> constants : spring_kernel.constants)
      buffers.push_back(constants.size());
    buffers.push_back(spring_kernel.force_floats * sizeof(float));
    require_memory(device, buffers);

    for (const Pair pair : stored) {
      auto& buffer = pairs_[index(pair)];
      buffer = queue_.zeros<float>(spring_kernel.pair_floats);
      host_pairs_[index(pair)] = buffer->map(CL_MAP_WRITE);
    }
    forces_ = queue_.zeros<float>(spring_kernel.force_floats);
    host_forces_ = forces_->map(CL_MAP_READ);
    if (spring_kernel.parts == 0) return;

    const OpenclChunks chunks(spring_kernel.parts, device, lanes);
    cl::Kernel kernel(queue_.build(spring_kernel.text), spring_kernel.name);
    kernel.setArg(1, forces_->buffer());
    cl_uint argument = 2;
    for (const std::span<const std::byte> constants : spring_kernel.constants) {
      constants_.push_back(queue_.copy_of(constants));
      kernel.setArg(argument++, constants_.back().buffer());
    }
    kernel.setArg(argument++, static_cast<cl_uint>(spring_kernel.parts));
    kernel.setArg(argument, static_cast<cl_uint>(chunks.per_item));
    launch_ = {kernel, chunks.items};
  }
  ~SpringDevice() {
    // A driver never frees a buffer that is released while mapped. Unmapped as if read: nothing is copied
    // back.
    try {
      for (std::size_t i = 0; i < pair_kinds; ++i)
        if (pairs_[i]) pairs_[i]->unmap(host_pairs_[i], CL_MAP_READ);
      forces_->unmap(host_forces_, CL_MAP_READ);
      queue_.finish();
    } catch (const cl::Error&) {
      // After a reported failure, some are not mapped; the end of the process frees the others.
    }
  }
  SpringDevice(const SpringDevice&) = delete;
  SpringDevice& operator=(const SpringDevice&) = delete;

  const DeviceQueue& queue() const { return queue_; }
  /// The nodes of a stored pair.
  std::span<float> pair(Pair stored) const { return host_pairs_[index(stored)]; }
  const float* forces() const { return host_forces_.data(); }

  /// Computes the forces of all springs from a stored pair, and waits for them. Throws cl::Error.
  void compute_forces(Pair stored) {
    if (!launch_) return;
    const auto& pair = *pairs_[index(stored)];
    auto& host_pair = host_pairs_[index(stored)];
    forces_->unmap(host_forces_, CL_MAP_READ);
    pair.unmap(host_pair, CL_MAP_WRITE);
    launch_->kernel.setArg(0, pair.buffer());
    queue_.launch(*launch_);
    host_pair = pair.map(CL_MAP_WRITE, false);
    host_forces_ = forces_->map(CL_MAP_READ);
  }

 private:
  DeviceQueue queue_;
  std::array<std::optional<OpenclBuffer<float>>, pair_kinds> pairs_;  // [Pair], the stored ones
  std::array<std::span<float>, pair_kinds> host_pairs_;               // mapped
  std::optional<OpenclBuffer<float>> forces_;
  std::span<float> host_forces_;  // mapped
  std::vector<OpenclBuffer<std::byte>> constants_;
  std::optional<Launch> launch_;  // empty without springs
};

/// Alternates: the device computes the forces of all springs, then the host's threads sum them at the nodes
/// and integrate. `Nodes`: the layout that both share, HostNodes or AlikeNodes.
template <class Nodes>
class Hybrid final : public Backend {
 public:
  Hybrid(Nodes nodes, const NodeKernel<Nodes>& kernel, const System& system, const OpenclDevice& device,
         int threads, int lanes, DeviceMemory memory)
      : integrator_(*nodes.integrator),
        threads_(threads),
        kernel_(kernel),
        nodes_(std::move(nodes)),
        // All forces are complete before a node is written, so pairs may share memory.
        device_(nodes_.spring_kernel(lanes), stored_pairs(integrator_, Storage::in_place), device, lanes,
                memory) {
    nodes_.forget_units();
    warm_up(*this, system.start, 1);
  }

  void set_state(const State& state) override { nodes_.write(state, device_.pair(present_).data()); }

  void step(int count) override {
    constexpr int most = 1 << 20;  // a ticket numbers a call's phases
    static_assert(most * max_stages <= ChunkTickets::most_phases);
    for (; count > most; count -= most) take_steps(most);
    take_steps(count);
  }

  State state() const override { return nodes_.read(device_.pair(present_).data()); }

  std::string device() const override { return device_.queue().label(); }
  /// Threads of the host or the device, whichever are more: they alternate.
  int threads() const override { return std::max(threads_, device_.queue().threads()); }
  bool runs_on_host() const override { return device_.queue().runs_on_host(); }
  std::optional<std::uint64_t> stored_springs() const override {
    if constexpr (requires { nodes_.stored_springs(); }) return nodes_.stored_springs();
    return std::nullopt;
  }

 private:
  /// Slices per chunk of a thread: 16, unless that makes too many chunks.
  std::size_t chunk_slices() const {
    return std::max<std::size_t>(16, nodes_.slices() / ChunkTickets::most_chunks + 1);
  }

  /// The stored pair of a role if the state is in `present`.
  Pair stored_pair(Pair role, Pair present) const {
    const Pair stored = storage_of(integrator_, role, Storage::in_place);
    if (stored == Pair::state) return present;
    if (stored == Pair::next) return present == Pair::state ? Pair::next : Pair::state;
    return stored;
  }

  /// The pair that has the state before the call's step number `step`.
  Pair present_at(std::size_t step) const {
    return step % 2 == 0 ? present_ : stored_pair(Pair::next, present_);
  }

  /// Integrates the nodes of one chunk of slices in the stage of the ticket's phase.
  void work_on(const ChunkTickets::Ticket& ticket) const {
    const Pair present = present_at(ticket.phase / integrator_.stage_count);
    MappedNodes mapped{.pairs = {}, .forces = device_.forces()};
    for (std::size_t i = 0; i < pair_kinds; ++i)
      mapped.pairs[i] = device_.pair(stored_pair(static_cast<Pair>(i), present)).data();
    const std::size_t begin = ticket.chunk * chunk_slices();
    kernel_.integrate(nodes_, mapped, ticket.phase % integrator_.stage_count, begin,
                      std::min(begin + chunk_slices(), nodes_.slices()));
  }

  /// One parallel region for all steps. Thread 0 drives the device; a phase is the host's part of a stage.
  void take_steps(int count) {
    const std::size_t stages = integrator_.stage_count;
    ChunkTickets tickets(static_cast<std::uint32_t>((nodes_.slices() + chunk_slices() - 1) / chunk_slices()),
                         static_cast<std::uint32_t>(threads_));
    const auto act = [&](const ChunkTickets::Ticket& ticket) { work_on(ticket); };
    std::exception_ptr failure;  // of thread 0; exceptions must not leave the region
#pragma omp parallel num_threads(threads_)
    {
      const auto thread = static_cast<std::uint32_t>(omp_get_thread_num());
      if (thread == 0) {
        try {
          for (std::size_t phase = 0; phase < static_cast<std::size_t>(count) * stages; ++phase) {
            device_.compute_forces(
                stored_pair(integrator_.stages[phase % stages].gather, present_at(phase / stages)));
            tickets.open();
            tickets.work(0, act);
            tickets.wait_until_finished();
          }
        } catch (...) {
          failure = std::current_exception();
        }
        tickets.close();
      } else {
        tickets.work_until_closed(thread, 0, act, [] {});  // the device may use the same cores: no spinning
      }
    }
    present_ = present_at(static_cast<std::size_t>(count));
    if (failure) opencl_call<std::runtime_error>([&] { std::rethrow_exception(failure); });
  }

  const Integrator& integrator_;
  int threads_;  // of the host
  NodeKernel<Nodes> kernel_;
  Nodes nodes_;
  SpringDevice device_;
  Pair present_ = Pair::state;
};

}  // namespace

std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const OpenclDevice& device, int threads, int lanes, DeviceMemory memory,
                                     const std::function<void(SteppedKind)>& before) {
  if (threads < 1)
    throw std::invalid_argument(fmt::format("hybrid needs at least one host thread, not {}", threads));
  return opencl_call<Unavailable>([&]() -> std::unique_ptr<Backend> {
    // With seven bodies in sixteen lanes, a step takes 1.05 to 1.1 times as long as with packed springs, with
    // thirteen 0.66 times (Intel Xeon).
    constexpr double lanes_per_body = 2;
    const auto alike = alike_bodies_for(system, AlikeSprings::slice_nodes, lanes_per_body);
    before(alike ? SteppedKind::alike_bodies : SteppedKind::bodies);
    if (alike)
      return std::make_unique<Hybrid<AlikeNodes>>(AlikeNodes(system, *alike, integrator, dt_s),
                                                  alike_node_kernels().front(), system, device, threads,
                                                  lanes, memory);
    return std::make_unique<Hybrid<HostNodes>>(HostNodes(system, integrator, dt_s), node_kernels().front(),
                                               system, device, threads, lanes, memory);
  });
}

std::unique_ptr<Backend> make_hybrid(const System& system, const Integrator& integrator, double dt_s,
                                     const ExecutionOptions& options) {
  const OpenclDevice device = device_for(options);
  return make_hybrid(system, integrator, dt_s, device, options.threads, lanes_for(device), options.memory,
                     [&](SteppedKind kind) {
                       try_driver({"hybrid", std::string(integrator.name), kind, options}, device);
                     });
}

}  // namespace mssim
