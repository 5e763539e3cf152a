#include <fmt/core.h>

#include <CL/opencl.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "backends/devices/device_queue.h"
#include "garment/contact/body_maps.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/garment_grid.h"
#include "kernels/parameters.h"

namespace mssim {
namespace {

/// Empty rows before the stiffnesses of a panel's first row: the reach of springs.
constexpr std::size_t rows_before = 2;

DressingPhase phase_of(const System& system, const DressingSettings& rules, bool draping) {
  const auto rule = phase_rule<float>(system, rules, draping);
  return {rule.damping, rule.gravity, rule.friction};
}

/// Number of steps after which seaming ends in any case.
int longest_seaming(const DressingSettings& rules, double dt_s) {
  constexpr double most = std::numeric_limits<int>::max() - 1;
  const DressingProgress open{1, false, 0};
  auto steps = static_cast<std::int64_t>(std::min(rules.longest_seaming_s / dt_s, most));
  while (steps > 0 && ends_seaming(rules, open, steps - 1, dt_s)) --steps;
  while (steps < static_cast<std::int64_t>(most) && !ends_seaming(rules, open, steps, dt_s)) ++steps;
  return static_cast<int>(steps);
}

DressingParameters parameters_of(const System& system, const DressingSettings& rules, double dt_s) {
  DressingParameters parameters{};
  parameters.surroundings = surroundings_of(system);
  parameters.seaming = phase_of(system, rules, false);
  parameters.draping = phase_of(system, rules, true);
  parameters.dt = static_cast<float>(dt_s);
  parameters.push_speed = static_cast<float>(rules.push_speed);
  const auto correction = correction_rule<float>(rules, dt_s);
  parameters.correction_limit = correction.limit;
  parameters.correction_rate = correction.rate_per_s;
  parameters.sewn_gap = static_cast<float>(rules.sewn_gap);
  parameters.seam_force = static_cast<float>(rules.seam_force);
  parameters.doublings_per_step = static_cast<float>(dt_s / rules.seam_force_doubling_s);
  const auto closing = closing_rule<float>(rules, dt_s);
  parameters.closing_most = closing.most;
  parameters.closing_speed = closing.speed;
  parameters.longest_seaming = longest_seaming(rules, dt_s);
  return parameters;
}

/// The level of each joint, above those of all earlier joints with which it shares a node.
std::vector<std::size_t> levels_of(const std::vector<GarmentGrid::Joint>& joints) {
  std::map<std::size_t, std::size_t> next;  // first free level of a node
  std::vector<std::size_t> levels;
  for (const GarmentGrid::Joint& joint : joints) {
    const std::size_t level = std::max({next[joint.node], next[joint.first], next[joint.second]});
    next[joint.node] = next[joint.first] = next[joint.second] = level + 1;
    levels.push_back(level);
  }
  return levels;
}

/// The constant part of a garment in the layout of the kernels (kernels/parameters.h).
struct OpenclPanels {
  /// Throws Unsupported as GarmentGrid does and if the kernels' 32-bit offsets are too small;
  /// std::invalid_argument if the springs are not those of the panels.
  OpenclPanels(const System& system, double dt_s) {
    const auto& garment = std::get<Garment>(system.topology);
    const GarmentGrid grid(system);
    const std::size_t plane = grid.inverse_mass.size();
    if (plane * panel_stencil.size() > std::numeric_limits<cl_int>::max())
      throw Unsupported(
          "the garment needs OpenCL buffers larger than the 8191 MiB that the kernels' 32-bit offsets reach; "
          "use fewer nodes");
    parameters = parameters_of(system, garment.dressing, dt_s);
    parameters.plane = static_cast<int>(plane);
    offset = grid.offset;
    inverse_mass.assign(grid.inverse_mass.data(), grid.inverse_mass.data() + plane);
    for (const AlignedArray& lengths : grid.rest)
      rest.insert(rest.end(), lengths.data(), lengths.data() + plane);

    std::vector<std::size_t> first_row;  // [panels] among the stiffnesses
    std::size_t rows = 0;
    for (const GarmentGrid::Panel& panel : grid.panels) {
      first_row.push_back(rows + rows_before);
      rows += rows_before + panel.rows;
    }
    parameters.spring_rows = static_cast<int>(rows);
    stiffness.assign(panel_stencil.size() * rows, 0);
    for (std::size_t d = 0; d < panel_stencil.size(); ++d)
      for (std::size_t p = 0; p < grid.panels.size(); ++p)
        std::ranges::copy(grid.panels[p].stiffness[d],
                          stiffness.begin() + static_cast<std::ptrdiff_t>(d * rows + first_row[p]));

    std::map<const BodyMaps*, std::size_t> first_pixel;
    for (const GarmentGrid::Block& block : grid.blocks) {
      const GarmentGrid::Panel& panel = grid.panels[block.panel];
      DressingBlock own{static_cast<int>(panel.first + block.begin * panel.stride),
                        static_cast<int>(block.end - block.begin),
                        static_cast<int>(panel.columns),
                        static_cast<int>(panel.stride),
                        static_cast<int>(first_row[block.panel] + block.begin),
                        block.begin != 0 ? 1 : 0,
                        {},
                        0};
      if (panel.body != nullptr) {
        const auto [maps, is_new] = first_pixel.emplace(panel.body, pixels.size());
        if (is_new) pixels.insert(pixels.end(), panel.body->pixels().begin(), panel.body->pixels().end());
        own.body = panel.body->frame();
        own.first_pixel = static_cast<int>(maps->second);
      }
      blocks.push_back(own);
    }

    at_joint.assign(plane, 0);
    const auto add_node = [&](std::size_t node) {
      if (at_joint[node] == 0) joint_nodes.push_back(static_cast<cl_int>(node));
      at_joint[node] = -1;
    };
    std::ranges::for_each(grid.held, add_node);
    parameters.held_nodes = static_cast<int>(joint_nodes.size());
    const std::vector<std::size_t> levels = levels_of(grid.joints);
    const std::size_t level_count = levels.empty() ? 0 : std::ranges::max(levels) + 1;
    for (std::size_t level = 0; level < level_count; ++level) {
      for (std::size_t j = 0; j < levels.size(); ++j) {
        if (levels[j] != level) continue;
        const GarmentGrid::Joint& joint = grid.joints[j];
        const mssim::Joint& rule = garment.joints[j];
        joints.push_back({static_cast<int>(joint.node), static_cast<int>(joint.first),
                          static_cast<int>(joint.second), joint.fraction, static_cast<float>(rule.length),
                          static_cast<float>(rule.strength)});
        for (const std::size_t node : {joint.node, joint.first, joint.second}) add_node(node);
      }
      level_ends.push_back(static_cast<cl_int>(joints.size()));
    }
    parameters.joints = static_cast<int>(joints.size());
    parameters.joint_levels = static_cast<int>(level_ends.size());
    parameters.joint_nodes = static_cast<int>(joint_nodes.size());
  }

  /// Bytes of each of these arrays and of those of the state.
  std::vector<std::uint64_t> buffer_bytes() const {
    const auto bytes = [](const auto& values) {
      return std::uint64_t{values.size() * sizeof(values.front())};
    };
    const std::uint64_t plane = bytes(inverse_mass), vectors = 3 * plane;
    return {vectors,         vectors,       vectors,           vectors,           plane,
            plane,           bytes(rest),   bytes(pixels),     bytes(stiffness),  bytes(blocks),
            bytes(at_joint), bytes(joints), bytes(level_ends), bytes(joint_nodes)};
  }

  DressingParameters parameters{};
  std::vector<std::size_t> offset;  ///< [nodes] index of each node's float
  std::vector<DressingBlock> blocks;
  std::vector<BodyPixel> pixels;      ///< of all layers
  std::vector<float> inverse_mass;    ///< [plane]
  std::vector<float> rest;            ///< [directions][plane]
  std::vector<float> stiffness;       ///< [directions][spring_rows]
  std::vector<cl_int> at_joint;       ///< [plane] -1 for held nodes and those of joints, else 0
  std::vector<DressingJoint> joints;  ///< level by level
  std::vector<cl_int> level_ends;     ///< [levels]
  std::vector<cl_int> joint_nodes;    ///< held nodes first
};

/// panel_stencil for the kernels, without contractions, which would round differently in kernels of different
/// shapes.
std::string stencil_text() {
  std::string rows, columns;
  for (const GridSpring& spring : panel_stencil) {
    rows += fmt::format("{}{}", rows.empty() ? "" : ", ", spring.rows);
    columns += fmt::format("{}{}", columns.empty() ? "" : ", ", spring.columns);
  }
  return fmt::format(
      "#pragma OPENCL FP_CONTRACT OFF\n#define stencil_directions {}\n#define limited_directions "
      "{}\n__constant int stencil_rows[] = {{{}}};\n__constant int stencil_columns[] = {{{}}};\n",
      panel_stencil.size(), limited_directions, rows, columns);
}

std::string program_text_with(const char* kernels, int lanes) {
  return stencil_text() + program_text(lanes, {"lanes.h", "records.h", "spring_constants.h", "spring_law.h",
                                               "node_laws.h", "parameters.h", "stage.h", "body_contact.h",
                                               "garment_laws.h", "dressing.cl", kernels});
}

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
      sewn_.write([&](std::span<cl_int> sewn) { std::ranges::fill(sewn, open > 0 ? 0 : 1); });
      progress_.write([&](std::span<DressingState> progress) {
        progress.front() = {0, start.draping ? 1 : 0, 0, open, open};
      });
      if (begin_joints_) queue_.launch(*begin_joints_);
      queue_.finish();
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
      const auto progress = progress_.read([](std::span<const DressingState> all) { return all.front(); });
      return {static_cast<std::size_t>(progress.open_joints), progress.draping != 0, progress.seamed_at};
    });
  }

  std::string device() const override { return queue_.label(); }
  int threads() const override { return queue_.threads(); }
  bool runs_on_host() const override { return queue_.runs_on_host(); }

 private:
  /// Copies values to a buffer that from now on only kernels use.
  template <class Values>
  const cl::Buffer& kept(const Values& values) {
    return kept_.emplace_back(queue_.copy_of(std::as_bytes(std::span(values)))).buffer();
  }

  /// Makes the launches of a step; their arguments do not change.
  void make_launches(const OpenclPanels& panels, const DressingShape& shape, std::uint32_t sweeps) {
    const std::vector<float> nothing(3 * plane_);
    const std::vector<cl::Buffer> grid{kept(std::span(&panels.parameters, 1)),
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
    const cl::Program on_panels = queue_.build(program_text_with("dressing_step.cl", shape.lanes));
    const cl::Buffer blocks = kept(panels.blocks), at_joint = kept(panels.at_joint);
    const auto on_blocks = [&](const char* name, const auto&... arguments) {
      launches_.push_back(launch(on_panels, name, panels.blocks.size(), shape.items, blocks, arguments...));
    };
    const auto yes_if = [](bool condition) { return cl_int{condition ? 1 : 0}; };
    on_blocks("update_velocities", kept(panels.pixels), yes_if(sweeps > 0));
    // Sweeps alternate: forwards within the blocks, then between them; backwards in reverse.
    std::uint32_t done = 0;
    do {
      const bool back = done + 1 < sweeps, on = done + 2 < sweeps;
      if (done < sweeps) on_blocks("correct_between_blocks", yes_if(back));
      on_blocks("correct_blocks", at_joint, yes_if(back), yes_if(on), yes_if(!on));
      done += 2;
    } while (done < sweeps);

    if (panels.joints.empty()) return;
    const cl::Program on_joints = queue_.build(program_text_with("dressing_joints.cl", 1));
    const cl::Buffer joints = kept(panels.joints), ends = kept(panels.level_ends),
                     nodes = kept(panels.joint_nodes);
    const auto one_group = [&](const char* name) {
      return launch(on_joints, name, 1, shape.items, joints, ends, nodes, sewn_.buffer());
    };
    begin_joints_ = one_group("begin_joints");
    launches_.push_back(one_group("step_joints"));
  }

  void put(const std::vector<Vec3d>& vectors, const OpenclBuffer<float>& buffer) {
    buffer.write([&](std::span<float> planes) {
      for (std::size_t i = 0; i < offset_.size(); ++i) {
        write_vector(&planes[offset_[i]], plane_, vectors[i]);
      }
    });
  }
  std::vector<Vec3d> taken(const OpenclBuffer<float>& buffer) const {
    return buffer.read([&](std::span<const float> planes) {
      std::vector<Vec3d> vectors;
      vectors.reserve(offset_.size());
      for (const std::size_t at : offset_) vectors.push_back(read_vector(&planes[at], plane_));
      return vectors;
    });
  }

  const Garment& garment_;
  std::vector<std::size_t> offset_;  ///< [nodes] index of each node's float
  std::size_t plane_;                ///< floats per component
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
