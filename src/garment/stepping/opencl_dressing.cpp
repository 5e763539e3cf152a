#include "garment/stepping/opencl_dressing.h"

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "backends/devices/buffer.h"
#include "backends/devices/call.h"
#include "backends/devices/program.h"
#include "backends/devices/sub_device.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/opencl_panels.h"

namespace mssim {
namespace {

/// Launches between two waits for the queue to run empty: waiting is rare enough to cost nothing, and a
/// driver never has to hold more unfinished commands than this.
constexpr std::size_t longest_queue = 256;

class OpenclDressing final : public DressingBackend {
 public:
  OpenclDressing(const System& system, const OpenclDevice& device, DeviceMemory memory,
                 const DressingShape& shape, const OpenclPanels& panels)
      : garment_(std::get<Garment>(system.topology)),
        device_(device),
        memory_(memory),
        place_(panels.place),
        plane_(panels.inverse_mass.size()),
        context_(cl::Device(device.id, true)),
        queue_(context_, cl::Device(device.id, true)),
        position_(zeros<float>(3 * plane_)),
        velocity_(zeros<float>(3 * plane_)),
        sewn_(zeros<cl_int>(panels.joints.size())),
        progress_(zeros<DressingState>(1)) {
    make_launches(panels, shape, correction_sweeps(garment_.dressing));
    // Drivers finish compiling at a kernel's first launch with a range.
    OpenclDressing::set_state(system.start);
    OpenclDressing::step(1);
    OpenclDressing::set_state(system.start);
  }

  void set_state(const State& state) override {
    const DressingProgress start = first_progress(garment_, state);
    opencl_call<std::runtime_error>([&] {
      put(state.position, position_);
      put(state.velocity, velocity_);
      const auto open = static_cast<int>(start.open_joints);
      sewn_.write(queue_, [&](std::span<cl_int> sewn) { std::ranges::fill(sewn, open > 0 ? 0 : 1); });
      progress_.write(queue_, [&](std::span<DressingState> progress) {
        progress.front() = {0, start.draping ? 1 : 0, 0, open, open};
      });
      if (begin_joints_) enqueue(*begin_joints_);
      queue_.finish();
    });
  }

  void step(int count) override {
    opencl_call<std::runtime_error>([&] {
      std::size_t queued = 0;
      for (int i = 0; i < count; ++i)
        for (const Launch& launch : launches_) {
          enqueue(launch);
          if (++queued % longest_queue == 0) queue_.finish();
        }
      queue_.finish();
    });
  }

  State state() const override {
    return opencl_call<std::runtime_error>([&] {
      return State{taken(position_), taken(velocity_), progress().draping};
    });
  }

  DressingProgress progress() const override {
    return opencl_call<std::runtime_error>([&]() -> DressingProgress {
      const auto memory = progress_.map(queue_, CL_MAP_READ);
      const DressingState progress = memory.front();
      progress_.unmap(queue_, memory, CL_MAP_READ);
      queue_.finish();
      return {static_cast<std::size_t>(progress.open_joints), progress.draping != 0, progress.seamed_at};
    });
  }

  std::string device() const override { return label_of(device_, memory_); }
  int threads() const override { return threads_of(device_); }
  bool runs_on_host() const override { return device_.type == OpenclDeviceType::cpu; }

 private:
  struct Launch {
    cl::Kernel kernel;
    cl::NDRange global, local;
  };

  void enqueue(const Launch& launch) {
    queue_.enqueueNDRangeKernel(launch.kernel, cl::NullRange, launch.global, launch.local);
  }

  template <class T>
  OpenclBuffer<T> zeros(std::size_t size) {
    OpenclBuffer<T> buffer(context_, device_, memory_, std::max<std::size_t>(1, size));
    buffer.write(queue_, [](std::span<T> array) { std::ranges::fill(array, T{}); });
    return buffer;
  }
  /// A buffer that only kernels see from now on. OpenCL has no empty ones.
  template <class T>
  const cl::Buffer& kept(std::span<const T> values) {
    const auto bytes = std::as_bytes(values);
    const auto& buffer =
        kept_.emplace_back(context_, device_, memory_, std::max<std::size_t>(1, bytes.size()));
    buffer.write(queue_, [&](std::span<std::byte> array) { std::ranges::copy(bytes, array.begin()); });
    return buffer.buffer();
  }
  template <class T>
  const cl::Buffer& kept(const std::vector<T>& values) {
    return kept(std::span<const T>(values));
  }

  /// The launches of a step, whose arguments are set once and for all.
  void make_launches(const OpenclPanels& panels, const DressingShape& shape, std::uint32_t sweeps) {
    const std::vector<float> nothing(3 * plane_);
    const std::vector<cl::Buffer> sheet{kept(std::span<const DressingParameters>(&panels.parameters, 1)),
                                        position_.buffer(),
                                        kept(nothing),  // moved
                                        velocity_.buffer(),
                                        kept(nothing),  // pull
                                        kept(panels.inverse_mass),
                                        kept(panels.inverse_mass),  // free
                                        kept(panels.rest),
                                        kept(panels.stiffness),
                                        progress_.buffer()};
    const auto launch = [&](const cl::Program& program, const char* name, std::size_t groups,
                            std::size_t items, const auto&... arguments) {
      Launch made{cl::Kernel(program, name), cl::NDRange(groups * items), cl::NDRange(items)};
      cl_uint argument = 0;
      for (const cl::Buffer& buffer : sheet) made.kernel.setArg(argument++, buffer);
      (made.kernel.setArg(argument++, arguments), ...);
      return made;
    };
    const cl::Device device(device_.id, true);
    const cl::Program on_panels = build_program(context_, device, panels_program_text(shape.lanes));
    const cl::Buffer blocks = kept(panels.blocks), at_joint = kept(panels.at_joint);
    const auto on_blocks = [&](const char* name, const auto&... arguments) {
      launches_.push_back(launch(on_panels, name, panels.blocks.size(), shape.items, blocks, arguments...));
    };
    const auto yes_if = [](bool condition) { return cl_int{condition ? 1 : 0}; };
    on_blocks("update_velocities", kept(panels.pixels), yes_if(sweeps > 0));
    // Sweeps go forwards and backwards by turns: within the blocks, then between them, and back.
    std::uint32_t done = 0;
    do {
      const bool back = done + 1 < sweeps, on = done + 2 < sweeps;
      if (done < sweeps) on_blocks("correct_between_blocks", yes_if(back));
      on_blocks("correct_blocks", at_joint, yes_if(back), yes_if(on), yes_if(!on));
      done += 2;
    } while (done < sweeps);

    if (panels.joints.empty()) return;
    const cl::Program on_joints = build_program(context_, device, joints_program_text());
    const cl::Buffer joints = kept(panels.joints), ends = kept(panels.level_ends),
                     nodes = kept(panels.joint_nodes);
    const auto one_group = [&](const char* name) {
      return launch(on_joints, name, 1, shape.items, joints, ends, nodes, sewn_.buffer());
    };
    begin_joints_ = one_group("begin_joints");
    launches_.push_back(one_group("step_joints"));
  }

  void put(const std::vector<Vec3d>& vectors, const OpenclBuffer<float>& buffer) {
    buffer.write(queue_, [&](std::span<float> planes) {
      for (std::size_t i = 0; i < place_.size(); ++i) {
        const auto value = vec3_cast<float>(vectors[i]);
        planes[place_[i]] = value.x;
        planes[plane_ + place_[i]] = value.y;
        planes[2 * plane_ + place_[i]] = value.z;
      }
    });
  }
  std::vector<Vec3d> taken(const OpenclBuffer<float>& buffer) const {
    const auto planes = buffer.map(queue_, CL_MAP_READ);
    std::vector<Vec3d> vectors;
    vectors.reserve(place_.size());
    for (const std::size_t at : place_)
      vectors.push_back(
          vec3_cast<double>(Vec3<float>{planes[at], planes[plane_ + at], planes[2 * plane_ + at]}));
    buffer.unmap(queue_, planes, CL_MAP_READ);
    queue_.finish();
    return vectors;
  }

  const Garment& garment_;
  OpenclDevice device_;
  DeviceMemory memory_;
  std::vector<std::size_t> place_;  ///< [nodes] float of a node
  std::size_t plane_;               ///< floats of a component
  cl::Context context_;
  cl::CommandQueue queue_;
  OpenclBuffer<float> position_, velocity_;  ///< [3][plane]
  OpenclBuffer<cl_int> sewn_;                ///< [joints]
  OpenclBuffer<DressingState> progress_;     ///< [1]
  std::deque<OpenclBuffer<std::byte>> kept_;
  std::optional<Launch> begin_joints_;
  std::vector<Launch> launches_;  ///< of a step
};

}  // namespace

DressingShape DressingShape::of(const OpenclDevice& device, int lanes) {
  if (lanes > 1) return {lanes, 1};
  constexpr std::size_t good_group = 256;
  const std::size_t largest = cl::Device(device.id, true).getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>();
  return {lanes, std::min(good_group, largest)};
}

std::unique_ptr<DressingBackend> make_opencl_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const OpenclDevice& device,
                                                      DeviceMemory memory, const DressingShape& shape) {
  require_semi_euler(integrator);
  const OpenclPanels panels(system, dt_s);
  require_memory(device, panels.buffer_bytes());
  return opencl_call<Unavailable>(
      [&] { return std::make_unique<OpenclDressing>(system, device, memory, shape, panels); });
}

}  // namespace mssim
