#include "application/run.h"

#include <memory>

#include "commands/command.h"
#include "commands/options.h"

namespace mssim {

std::function<int()> declare_run(Arguments& arguments) {
  const auto options = std::make_shared<RunOptions>();
  const auto look = std::make_shared<PictureChoice>();
  arguments
      .add("--scene NAME|FILE", options->scene, "Scene to simulate: a name (see mssim list scenes) or a file")
      .offers(scene_names)
      .required();
  declare_stepping(
      arguments, *options,
      "Frames per simulated second of the trace, the energy curve and the pictures (default: 60)");
  arguments.add(
      "--precision WORD", options->precision,
      "single, or double with --backend serial, or openmp and an explicit integrator (default: that of "
      "the backend, which is single unless it is called NAME:double)",
      one_of("precision", {"single", "double"}));
  arguments.add("--trace FILE", options->files.trace,
                "Write an H5MD trace to this file, NAME.h5, and NAME.xdmf for ParaView next to it");
  arguments.add("--energy-curve FILE", options->files.energy_curve,
                "Write the energies of all frames to this CSV file");
  const Argument pictures = arguments.add(
      "--pictures DIR", options->files.pictures,
      "Draw every frame into this folder while the simulation runs, as PNG; it must be new or empty");
  declare_pictures(arguments, *look, usual_picture_size, pictures);
  arguments.add_flag(
      "--losses", options->losses,
      "Account for the energy lost to damping, friction, bounces and the integrator; computes a "
      "double-precision step for every step (not for garments)");
  return [options, look] {
    options->pictures = picture_options(*look, usual_picture_size, 0);
    return run_scene(*options);
  };
}

}  // namespace mssim
