#include "backends/dressing/panel_joints.h"

#include <algorithm>
#include <cmath>

#include "backends/dressing/seam_force.h"
#include "model/vec3.h"

namespace mssim {
namespace {

using Vector = Vec3<float>;

Vector at(const Float3Arrays& arrays, std::size_t i) {
  return {arrays.x.data()[i], arrays.y.data()[i], arrays.z.data()[i]};
}
void put(Float3Arrays& arrays, std::size_t i, const Vector& value) {
  arrays.x.data()[i] = value.x;
  arrays.y.data()[i] = value.y;
  arrays.z.data()[i] = value.z;
}
void add(Float3Arrays& arrays, std::size_t i, const Vector& value) { put(arrays, i, at(arrays, i) + value); }

/// The point of its edge that a joint is sewn to.
Vector on_edge(const PanelSheet::Joint& joint, const Float3Arrays& arrays) {
  const Vector first = at(arrays, joint.first);
  return first + joint.share * (at(arrays, joint.second) - first);
}

}  // namespace

void pull_joints(PanelDressing& dressing) {
  PanelSheet& sheet = dressing.sheet;
  const Dressing& rules = dressing.garment.dressing;
  for (const PanelSheet::Joint& joint : sheet.joints)
    for (const std::size_t node : {joint.node, joint.first, joint.second}) put(sheet.pull, node, {});
  const double time_s = static_cast<double>(dressing.steps) * dressing.dt_s;
  const float* inverse_mass = sheet.inverse_mass.data();
  for (std::size_t j = 0; j < sheet.joints.size(); ++j) {
    if (sheet.sewn[j] != 0) continue;
    const PanelSheet::Joint& joint = sheet.joints[j];
    const Vector gap = on_edge(joint, sheet.position) - at(sheet.position, joint.node);
    const float distance = std::sqrt(dot(gap, gap));
    if (distance < static_cast<float>(rules.sewn_gap)) {
      sheet.sewn[j] = 1;
      --dressing.progress.open_joints;
      continue;
    }
    const Vector force =
        static_cast<float>(seam_force(rules, dressing.garment.joints[j], time_s)) / distance * gap;
    add(sheet.pull, joint.node, inverse_mass[joint.node] * force);
    add(sheet.pull, joint.first, -(1 - joint.share) * inverse_mass[joint.first] * force);
    add(sheet.pull, joint.second, -joint.share * inverse_mass[joint.second] * force);
  }
}

void close_sewn_joints(PanelDressing& dressing) {
  PanelSheet& sheet = dressing.sheet;
  const Dressing& rules = dressing.garment.dressing;
  const float share_per_s = static_cast<float>(rules.closing_share / dressing.dt_s);
  const float speed = static_cast<float>(rules.closing_speed);
  const float* inverse_mass = sheet.inverse_mass.data();
  for (std::size_t j = 0; j < sheet.joints.size(); ++j) {
    if (sheet.sewn[j] == 0) continue;
    const PanelSheet::Joint& joint = sheet.joints[j];
    const float node = inverse_mass[joint.node];
    const float first = (1 - joint.share) * inverse_mass[joint.first];
    const float second = joint.share * inverse_mass[joint.second];
    // The two ends of an edge may be the same node.
    const float mobility =
        node + (joint.first == joint.second ? inverse_mass[joint.first]
                                            : (1 - joint.share) * first + joint.share * second);
    if (mobility == 0) continue;
    const Vector gap = on_edge(joint, sheet.moved) - at(sheet.moved, joint.node);
    const float closing = std::min(share_per_s, speed / (std::sqrt(dot(gap, gap)) + 1e-9F));
    const Vector impulse =
        1 / mobility * (on_edge(joint, sheet.velocity) - at(sheet.velocity, joint.node) + closing * gap);
    add(sheet.velocity, joint.node, node * impulse);
    add(sheet.velocity, joint.first, -first * impulse);
    add(sheet.velocity, joint.second, -second * impulse);
  }
}

}  // namespace mssim
