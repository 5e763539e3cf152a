#include "garment/stepping/garment_grid.h"

#include <map>
#include <span>
#include <stdexcept>
#include <utility>

#include "backends/interface/backend.h"

namespace mssim {
namespace {

constexpr auto directions = std::span(panel_stencil).first<limited_directions>();

using SpringNumbers = std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>;

std::pair<std::uint32_t, std::uint32_t> key(std::uint32_t first, std::uint32_t second) {
  return std::minmax(first, second);
}

/// Appends the springs of a direction that a row owns.
void append_row(const GarmentPanel& panel, std::uint32_t row, const GridSpring& direction,
                const SpringNumbers& numbers, std::vector<std::uint32_t>& order) {
  const std::uint32_t other_row = row + static_cast<std::uint32_t>(direction.rows);
  for (std::uint32_t column = 0; column < panel.columns; ++column) {
    const std::int64_t other_column = std::int64_t{column} + direction.columns;
    if (other_column < 0 || other_column >= panel.columns) continue;
    const auto found = numbers.find(
        key(panel.node(row, column), panel.node(other_row, static_cast<std::uint32_t>(other_column))));
    if (found == numbers.end())
      throw std::invalid_argument(fmt::format("panel {} lacks a spring of its stencil", panel.name));
    order.push_back(found->second);
  }
}

constexpr std::size_t widest_vector = 16, empty_rows = 2;

/// The direction of a spring between two nodes of a panel, from the node that owns it. Throws if the stencil
/// has none.
std::size_t direction_of(const GarmentPanel& panel, std::uint32_t& owner, std::uint32_t& other) {
  if (other < owner) std::swap(owner, other);
  const auto rows = std::int64_t{panel.row_of(other)} - panel.row_of(owner);
  const auto columns = std::int64_t{panel.column_of(other)} - panel.column_of(owner);
  for (std::size_t d = 0; d < panel_stencil.size(); ++d)
    if (other < panel.first_node + panel.nodes() && rows == panel_stencil[d].rows &&
        columns == panel_stencil[d].columns)
      return d;
  throw std::invalid_argument(fmt::format("panel {} has a spring that is not in its stencil", panel.name));
}

/// The first rows of a panel's blocks, which are corrected in parallel, then its number of rows.
std::vector<std::uint32_t> correction_blocks(const GarmentPanel& panel) {
  // Small enough to give several threads work, large enough for corrections to propagate.
  constexpr std::uint32_t block_rows = 16;  // at least
  std::vector<std::uint32_t> begins{0};
  for (std::uint32_t row = block_rows; row + block_rows <= panel.rows; row += block_rows)
    begins.push_back(row);
  begins.push_back(panel.rows);
  return begins;
}

}  // namespace

std::vector<std::uint32_t> correction_order(const Garment& garment, const std::vector<Spring>& springs) {
  SpringNumbers numbers;
  for (std::uint32_t spring = 0; spring < springs.size(); ++spring)
    numbers[key(springs[spring].first, springs[spring].second)] = spring;
  std::vector<std::uint32_t> order;
  for (const GarmentPanel& panel : garment.panels) {
    const std::vector<std::uint32_t> blocks = correction_blocks(panel);
    for (std::size_t block = 0; block + 1 < blocks.size(); ++block)
      for (const GridSpring& direction : directions)
        for (std::uint32_t row = blocks[block];
             row + static_cast<std::uint32_t>(direction.rows) < blocks[block + 1]; ++row)
          append_row(panel, row, direction, numbers, order);
    for (std::size_t block = 1; block + 1 < blocks.size(); ++block)
      for (const GridSpring& direction : directions)
        if (direction.rows != 0) append_row(panel, blocks[block] - 1, direction, numbers, order);
  }
  return order;
}

GarmentGrid::GarmentGrid(const System& system) : offset(system.nodes()) {
  const auto& garment = std::get<Garment>(system.topology);
  std::size_t floats = 0;
  for (const GarmentPanel& panel : garment.panels) {
    const std::size_t stride = round_up(panel.columns, widest_vector) + widest_vector;
    panels.push_back(
        {panel.rows, panel.columns, stride, floats + empty_rows * stride, {}, garment.body_met_by(panel)});
    for (std::vector<float>& stiffness : panels.back().stiffness) stiffness.assign(panel.rows, 0);
    floats += (panel.rows + 2 * empty_rows) * stride;
    for (std::uint32_t row = 0; row < panel.rows; ++row)
      for (std::uint32_t column = 0; column < panel.columns; ++column)
        offset[panel.node(row, column)] = panels.back().first + row * stride + column;
    const std::vector<std::uint32_t> begins = correction_blocks(panel);
    for (std::size_t block = 0; block + 1 < begins.size(); ++block)
      blocks.push_back({panels.size() - 1, begins[block], begins[block + 1]});
  }
  if (garment.dressing.edge_held && !garment.joints.empty())
    for (const GarmentPanel& panel : garment.panels)
      for (std::uint32_t column = 0; column < panel.columns; ++column)
        held.push_back(offset[panel.node(panel.rows - 1, column)]);
  for (Float3Arrays* arrays : {&position, &moved, &velocity, &pull}) *arrays = Float3Arrays(floats);
  inverse_mass = AlignedArray(floats);
  free = AlignedArray(floats);
  for (AlignedArray& lengths : rest) lengths = AlignedArray(floats);

  for (std::size_t i = 0; i < system.nodes(); ++i)
    inverse_mass.data()[offset[i]] = static_cast<float>(1 / system.node_mass[i]);
  for (const std::uint32_t pin : system.pins) inverse_mass.data()[offset[pin]] = 0;
  for (const Spring& spring : system.springs) {
    std::uint32_t owner = spring.first, other = spring.second;
    const GarmentPanel& panel = garment.panel_of(std::min(owner, other));
    const std::size_t direction = direction_of(panel, owner, other);
    rest[direction].data()[offset[owner]] = spring.rest_length;
    const auto number = static_cast<std::size_t>(&panel - garment.panels.data());
    float& stiffness = panels[number].stiffness[direction][panel.row_of(owner)];
    const auto own = static_cast<float>(system.materials[spring.kind].stiffness);
    if (stiffness != 0 && stiffness != own)
      throw Unsupported(
          "panel {} has a row whose springs of one direction differ in stiffness; give them one", panel.name);
    stiffness = own;
  }
  for (const mssim::Joint& joint : garment.joints)
    joints.push_back({offset[joint.node], offset[joint.edge_first], offset[joint.edge_second],
                      static_cast<float>(joint.edge_share)});
  set_state(system.start);
}

void GarmentGrid::set_state(const State& state) {
  for (std::size_t i = 0; i < offset.size(); ++i) {
    position.put(offset[i], vec3_cast<float>(state.position[i]));
    velocity.put(offset[i], vec3_cast<float>(state.velocity[i]));
  }
}

State GarmentGrid::state() const {
  State state;
  for (const std::size_t at : offset)
    state.add(vec3_cast<double>(position.at(at)), vec3_cast<double>(velocity.at(at)));
  return state;
}

}  // namespace mssim
