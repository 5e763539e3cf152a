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

#include "backends/devices/device_queue.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/opencl_panels.h"

namespace mssim {
namespace {

class OpenclDressing final : public DressingBackend {
 public:
  OpenclDressing(const System& system, const OpenclDevice& device, DeviceMemory memory,
                 const DressingShape& shape, const OpenclPanels& panels)
      : garment_(std::get<Garment>(system.topology)),
        offset_(panels.offset),
        plane_(panels.inverse_mass.size()),
        queue_(device, memory),
        position_(queue_.zeros<float>(3 * plane_)),
        velocity_(queue_.zeros<float>(3 * plane_)),
        sewn_(queue_.zeros<cl_int>(panels.joints.size())),
        progress_(queue_.zeros<DressingState>(1)) {
    make_launches(panels, shape, correction_sweeps(garment_.dressing));
    warm_up(*this, system.start, 1);
  }

  void set_state(const State& state) override {
    const DressingProgress start = first_progress(garment_, state);
    opencl_call<std::runtime_error>([&] {
      put(state.position, position_);
      put(state.velocity, velocity_);
      const auto open = static_cast<int>(start.open_joints);
      sewn_.write(queue_.commands(),
                  [&](std::span<cl_int> sewn) { std::ranges::fill(sewn, open > 0 ? 0 : 1); });
      progress_.write(queue_.commands(), [&](std::span<DressingState> progress) {
        progress.front() = {0, start.draping ? 1 : 0, 0, open, open};
      });
      if (begin_joints_) queue_.launch(*begin_joints_);
      queue_.commands().finish();
    });
  }

  void step(int count) override {
    opencl_call<std::runtime_error>(
        [&] { queue_.take_steps(count, [&](int) -> const std::vector<Launch>& { return launches_; }); });
  }

  State state() const override {
    return opencl_call<std::runtime_error>([&] {
      return State{taken(position_), taken(velocity_), progress().draping};
    });
  }

  DressingProgress progress() const override {
    return opencl_call<std::runtime_error>([&]() -> DressingProgress {
      const auto memory = progress_.map(queue_.commands(), CL_MAP_READ);
      const DressingState progress = memory.front();
      progress_.unmap(queue_.commands(), memory, CL_MAP_READ);
      queue_.commands().finish();
      return {static_cast<std::size_t>(progress.open_joints), progress.draping != 0, progress.seamed_at};
    });
  }

  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 private:
  /// A buffer that only kernels see from now on.
  template <class T>
  const cl::Buffer& kept(std::span<const T> values) {
    return kept_.emplace_back(queue_.copy_of(std::as_bytes(values))).buffer();
  }
  template <class T>
  const cl::Buffer& kept(const std::vector<T>& values) {
    return kept(std::span<const T>(values));
  }

  /// The launches of a step, whose arguments are set once and for all.
  void make_launches(const OpenclPanels& panels, const DressingShape& shape, std::uint32_t sweeps) {
    const std::vector<float> nothing(3 * plane_);
    const std::vector<cl::Buffer> grid{kept(std::span<const DressingParameters>(&panels.parameters, 1)),
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
      Launch made{cl::Kernel(program, name), {cl::NDRange(groups * items), cl::NDRange(items)}};
      cl_uint argument = 0;
      for (const cl::Buffer& buffer : grid) made.kernel.setArg(argument++, buffer);
      (made.kernel.setArg(argument++, arguments), ...);
      return made;
    };
    const cl::Program on_panels = queue_.build(panels_program_text(shape.lanes));
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
    const cl::Program on_joints = queue_.build(joints_program_text());
    const cl::Buffer joints = kept(panels.joints), ends = kept(panels.level_ends),
                     nodes = kept(panels.joint_nodes);
    const auto one_group = [&](const char* name) {
      return launch(on_joints, name, 1, shape.items, joints, ends, nodes, sewn_.buffer());
    };
    begin_joints_ = one_group("begin_joints");
    launches_.push_back(one_group("step_joints"));
  }

  void put(const std::vector<Vec3d>& vectors, const OpenclBuffer<float>& buffer) {
    buffer.write(queue_.commands(), [&](std::span<float> planes) {
      for (std::size_t i = 0; i < offset_.size(); ++i) {
        const auto value = vec3_cast<float>(vectors[i]);
        planes[offset_[i]] = value.x;
        planes[plane_ + offset_[i]] = value.y;
        planes[2 * plane_ + offset_[i]] = value.z;
      }
    });
  }
  std::vector<Vec3d> taken(const OpenclBuffer<float>& buffer) const {
    const auto planes = buffer.map(queue_.commands(), CL_MAP_READ);
    std::vector<Vec3d> vectors;
    vectors.reserve(offset_.size());
    for (const std::size_t at : offset_)
      vectors.push_back(
          vec3_cast<double>(Vec3<float>{planes[at], planes[plane_ + at], planes[2 * plane_ + at]}));
    buffer.unmap(queue_.commands(), planes, CL_MAP_READ);
    queue_.commands().finish();
    return vectors;
  }

  const Garment& garment_;
  std::vector<std::size_t> offset_;  ///< [nodes] float of a node
  std::size_t plane_;                ///< floats of a component
  DeviceQueue queue_;
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
