#include <algorithm>

#include "backends/vectors/step_kernels.h"
#include "garment/stepping/step_panels.h"

namespace mssim {
namespace {

using Vector = Vec3<float>;

AtJoint<Vector> at(const Float3Arrays& arrays, const GarmentGrid::Joint& joint) {
  return {arrays.at(joint.node), arrays.at(joint.first), arrays.at(joint.second)};
}
void add(Float3Arrays& arrays, const GarmentGrid::Joint& joint, const AtJoint<Vector>& values) {
  // In sequence, because both ends of an edge may be the same node.
  arrays.put(joint.node, arrays.at(joint.node) + values.node);
  arrays.put(joint.first, arrays.at(joint.first) + values.first);
  arrays.put(joint.second, arrays.at(joint.second) + values.second);
}
AtJoint<float> inverse_masses(const GarmentGrid& grid, const GarmentGrid::Joint& joint) {
  const float* inverse_mass = grid.inverse_mass.data();
  return {inverse_mass[joint.node], inverse_mass[joint.first], inverse_mass[joint.second]};
}

class OpenMpDressing final : public DressingBackend {
 public:
  OpenMpDressing(const System& system, double dt_s, std::size_t threads,
                 const StepKernel<PanelDressing>& kernel)
      : kernel_(kernel),
        dressing_{system,
                  std::get<Garment>(system.topology),
                  GarmentGrid(system),
                  threads,
                  dt_s,
                  layer_collision(system, std::get<Garment>(system.topology), static_cast<int>(threads))} {
    OpenMpDressing::set_state(system.start);
  }

  void set_state(const State& state) override {
    dressing_.grid.set_state(state);
    dressing_.seaming.start(dressing_.garment, state);
  }
  void step(int count) override { kernel_.step(dressing_, count); }
  State state() const override {
    State state = dressing_.grid.state();
    state.draped = dressing_.seaming.progress.draping;
    return state;
  }
  int threads() const override { return static_cast<int>(dressing_.threads); }
  DressingProgress progress() const override { return dressing_.seaming.progress; }

 private:
  const StepKernel<PanelDressing> kernel_;
  PanelDressing dressing_;
};

}  // namespace

void pull_joints(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  const DressingSettings& rules = dressing.garment.dressing;
  for (const GarmentGrid::Joint& joint : grid.joints)
    for (const std::size_t node : {joint.node, joint.first, joint.second}) grid.pull.put(node, {});
  const double time_s = static_cast<double>(dressing.seaming.steps) * dressing.dt_s;
  for (std::size_t j = 0; j < grid.joints.size(); ++j) {
    if (dressing.seaming.sewn[j] != 0) continue;
    const GarmentGrid::Joint& joint = grid.joints[j];
    const auto pull = pull_of_joint(rules, dressing.garment.joints[j], time_s, at(grid.position, joint),
                                    inverse_masses(grid, joint));
    if (!pull) {
      dressing.seaming.sewn[j] = 1;
      continue;
    }
    add(grid.pull, joint, *pull);
  }
}

void close_sewn_joints(PanelDressing& dressing) {
  GarmentGrid& grid = dressing.grid;
  const auto rule = closing_rule<float>(dressing.garment.dressing, dressing.dt_s);
  for (std::size_t j = 0; j < grid.joints.size(); ++j) {
    if (dressing.seaming.sewn[j] == 0) continue;
    const GarmentGrid::Joint& joint = grid.joints[j];
    add(grid.velocity, joint,
        closing_of_joint(rule, joint.fraction, at(grid.moved, joint), at(grid.velocity, joint),
                         inverse_masses(grid, joint)));
  }
  if (!dressing.seaming.progress.draping)
    for (const std::size_t at : grid.held) grid.velocity.y.data()[at] = 0;
}

std::unique_ptr<DressingBackend> make_openmp_dressing(const System& system, const Integrator& integrator,
                                                      double dt_s, const ExecutionOptions& options) {
  require_semi_euler(integrator);
  return std::make_unique<OpenMpDressing>(
      system, dt_s, static_cast<std::size_t>(std::max(1, options.threads)),
      best_kernel(compiled_kernels<PanelDressing>(), Roots::fast, options.instruction_set));
}

}  // namespace mssim
