#include "garment/stepping/opencl_panels.h"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "backends/devices/device_queue.h"
#include "backends/interface/backend.h"
#include "garment/stepping/dressing_rules.h"
#include "garment/stepping/garment_grid.h"
#include "garment/stepping/panel_stencil.h"

namespace mssim {
namespace {

/// Rows of nothing before the stiffnesses of a panel's first row, as far as springs reach up.
constexpr std::size_t rows_before = 2;

DressingPhase phase_of(const System& system, const DressingSettings& rules, bool draping) {
  const auto rule = phase_rule<float>(system, rules, draping);
  return {rule.damping, rule.gravity, rule.friction};
}

/// Steps after which seaming ends in any case.
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

/// For each joint its level: after the levels of all joints before it that it has a node in common with.
std::vector<std::size_t> levels_of(const std::vector<GarmentGrid::Joint>& joints) {
  std::map<std::size_t, std::size_t> next;  // the first level that is free at a node
  std::vector<std::size_t> levels;
  for (const GarmentGrid::Joint& joint : joints) {
    const std::size_t level = std::max({next[joint.node], next[joint.first], next[joint.second]});
    next[joint.node] = next[joint.first] = next[joint.second] = level + 1;
    levels.push_back(level);
  }
  return levels;
}

}  // namespace

OpenclPanels::OpenclPanels(const System& system, double dt_s) {
  const auto& garment = std::get<Garment>(system.topology);
  if (garment.touching)
    throw Unsupported("opencl dresses without collisions between layers; serial and openmp have them");
  const GarmentGrid grid(system);
  const std::size_t plane = grid.inverse_mass.size();
  if (plane * panel_stencil.size() > std::numeric_limits<cl_int>::max())
    throw Unsupported(
        "the garment needs OpenCL buffers of more than the 8191 MiB that the kernels' 32-bit "
        "offsets reach");
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
      for (const std::size_t node : {joint.node, joint.first, joint.second}) {
        if (at_joint[node] == 0) joint_nodes.push_back(static_cast<cl_int>(node));
        at_joint[node] = -1;
      }
    }
    level_ends.push_back(static_cast<cl_int>(joints.size()));
  }
  parameters.joints = static_cast<int>(joints.size());
  parameters.joint_levels = static_cast<int>(level_ends.size());
  parameters.joint_nodes = static_cast<int>(joint_nodes.size());
}

std::vector<std::uint64_t> OpenclPanels::buffer_bytes() const {
  const auto bytes = [](const auto& values) { return std::uint64_t{values.size() * sizeof(values.front())}; };
  const std::uint64_t plane = bytes(inverse_mass), vectors = 3 * plane;
  return {vectors,         vectors,       vectors,           vectors,           plane,
          plane,           bytes(rest),   bytes(pixels),     bytes(stiffness),  bytes(blocks),
          bytes(at_joint), bytes(joints), bytes(level_ends), bytes(joint_nodes)};
}

namespace {

/// panel_stencil for the kernels. Contractions would round differently in kernels of different shapes.
std::string stencil_text() {
  std::string rows, columns;
  for (const GridSpring& spring : panel_stencil) {
    rows += (rows.empty() ? "" : ", ") + std::to_string(spring.rows);
    columns += (columns.empty() ? "" : ", ") + std::to_string(spring.columns);
  }
  return "#pragma OPENCL FP_CONTRACT OFF\n#define stencil_directions " +
         std::to_string(panel_stencil.size()) + "\n#define limited_directions " +
         std::to_string(limited_directions) + "\n__constant int stencil_rows[] = {" + rows +
         "};\n__constant int stencil_columns[] = {" + columns + "};\n";
}

std::string text_with(int lanes, const char* kernels) {
  return stencil_text() +
         program_text(
             lanes, {"lanes.h", "records.h", "spring_law.h", "acceleration_law.h", "floor_law.h",
                     "surroundings.h", "touch_floor.h", "body_frame.h", "body_contact.h", "elongation_law.h",
                     "joint_law.h", "dressing_parameters.h", "dressing.cl", kernels});
}

}  // namespace

std::string panels_program_text(int lanes) { return text_with(lanes, "dressing_step.cl"); }

std::string joints_program_text() { return text_with(1, "dressing_joints.cl"); }

}  // namespace mssim
