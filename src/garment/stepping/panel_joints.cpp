#include "garment/stepping/panel_joints.h"

#include "garment/stepping/at_joint.h"
#include "geometry/vec3.h"

namespace mssim {
namespace {

using Vector = Vec3<float>;

AtJoint<Vector> at(const Float3Arrays& arrays, const GarmentGrid::Joint& joint) {
  return {arrays.at(joint.node), arrays.at(joint.first), arrays.at(joint.second)};
}
void add(Float3Arrays& arrays, const GarmentGrid::Joint& joint, const AtJoint<Vector>& values) {
  // One after the other: the ends of an edge may be one node.
  arrays.put(joint.node, arrays.at(joint.node) + values.node);
  arrays.put(joint.first, arrays.at(joint.first) + values.first);
  arrays.put(joint.second, arrays.at(joint.second) + values.second);
}
AtJoint<float> inverse_masses(const GarmentGrid& grid, const GarmentGrid::Joint& joint) {
  const float* inverse_mass = grid.inverse_mass.data();
  return {inverse_mass[joint.node], inverse_mass[joint.first], inverse_mass[joint.second]};
}

}  // namespace

void pull_joints(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  const DressingSettings& rules = dressing.garment.dressing;
  for (const GarmentGrid::Joint& joint : grid.joints)
    for (const std::size_t node : {joint.node, joint.first, joint.second}) grid.pull.put(node, {});
  const double time_s = static_cast<double>(dressing.steps) * dressing.dt_s;
  for (std::size_t j = 0; j < grid.joints.size(); ++j) {
    if (grid.sewn[j] != 0) continue;
    const GarmentGrid::Joint& joint = grid.joints[j];
    const auto pull = pull_of_joint(rules, dressing.garment.joints[j], time_s, at(grid.position, joint),
                                    inverse_masses(grid, joint));
    if (!pull) {
      grid.sewn[j] = 1;
      --dressing.progress.open_joints;
      continue;
    }
    add(grid.pull, joint, *pull);
  }
}

void close_sewn_joints(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  const auto rule = closing_rule<float>(dressing.garment.dressing, dressing.dt_s);
  for (std::size_t j = 0; j < grid.joints.size(); ++j) {
    if (grid.sewn[j] == 0) continue;
    const GarmentGrid::Joint& joint = grid.joints[j];
    add(grid.velocity, joint,
        closing_of_joint(rule, joint.fraction, at(grid.moved, joint), at(grid.velocity, joint),
                         inverse_masses(grid, joint)));
  }
}

}  // namespace mssim
