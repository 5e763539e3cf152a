#include "garment/stepping/panel_joints.h"

#include "garment/stepping/at_joint.h"
#include "geometry/vec3.h"

namespace mssim {
namespace {

using Vector = Vec3<float>;

AtJoint<Vector> at(const Float3Arrays& arrays, const PanelSheet::Joint& joint) {
  return {arrays.at(joint.node), arrays.at(joint.first), arrays.at(joint.second)};
}
void add(Float3Arrays& arrays, const PanelSheet::Joint& joint, const AtJoint<Vector>& values) {
  // One after the other: the ends of an edge may be one node.
  arrays.put(joint.node, arrays.at(joint.node) + values.node);
  arrays.put(joint.first, arrays.at(joint.first) + values.first);
  arrays.put(joint.second, arrays.at(joint.second) + values.second);
}
AtJoint<float> inverse_masses(const PanelSheet& sheet, const PanelSheet::Joint& joint) {
  const float* inverse_mass = sheet.inverse_mass.data();
  return {inverse_mass[joint.node], inverse_mass[joint.first], inverse_mass[joint.second]};
}

}  // namespace

void pull_joints(PanelDressing& dressing) {
  PanelSheet& sheet = dressing.sheet;
  const Dressing& rules = dressing.garment.dressing;
  for (const PanelSheet::Joint& joint : sheet.joints)
    for (const std::size_t node : {joint.node, joint.first, joint.second}) sheet.pull.put(node, {});
  const double time_s = static_cast<double>(dressing.steps) * dressing.dt_s;
  for (std::size_t j = 0; j < sheet.joints.size(); ++j) {
    if (sheet.sewn[j] != 0) continue;
    const PanelSheet::Joint& joint = sheet.joints[j];
    const auto pull = pull_of_joint(rules, dressing.garment.joints[j], time_s, at(sheet.position, joint),
                                    inverse_masses(sheet, joint));
    if (!pull) {
      sheet.sewn[j] = 1;
      --dressing.progress.open_joints;
      continue;
    }
    add(sheet.pull, joint, *pull);
  }
}

void close_sewn_joints(PanelDressing& dressing) {
  PanelSheet& sheet = dressing.sheet;
  const auto rule = closing_rule<float>(dressing.garment.dressing, dressing.dt_s);
  for (std::size_t j = 0; j < sheet.joints.size(); ++j) {
    if (sheet.sewn[j] == 0) continue;
    const PanelSheet::Joint& joint = sheet.joints[j];
    add(sheet.velocity, joint,
        closing_of_joint(rule, joint.share, at(sheet.moved, joint), at(sheet.velocity, joint),
                         inverse_masses(sheet, joint)));
  }
}

}  // namespace mssim
