#include "commands/shared/run_provenance.h"

#include <algorithm>
#include <iterator>

#include "backends/devices/offer.h"
#include "mesh/tetgen.h"
#include "output/folders/provenance_file.h"
#include "text/text.h"

namespace mssim {
namespace {

std::vector<std::string>& arguments() {
  static std::vector<std::string> remembered;
  return remembered;
}

}  // namespace

void remember_arguments(int argc, char** argv) { arguments().assign(argv, argv + argc); }

Provenance run_provenance(int threads, bool uses_device) {
  Provenance provenance = gather_provenance(arguments(), threads);
  if (uses_device) {
    const OpenclOffer& offer = opencl_offer();
    for (const OpenclDevice& device : offer.devices)
      provenance.opencl_devices.push_back(device.platform + ": " + device.name + ", driver " +
                                          device.driver_version);
    std::ranges::copy(offer.troubles, std::back_inserter(provenance.opencl_devices));
  }
  if (const auto tetgen = find_tetgen())
    provenance.tetgen = tetgen->version + ", fnv1a_64 " + to_hex(tetgen->fnv1a_64);
  return provenance;
}

std::string command_line(const Provenance& provenance) {
  std::string text;
  for (const std::string& argument : provenance.command_line)
    text.append(text.empty() ? "" : " ").append(shell_word(argument));
  return text;
}

TraceHeader trace_header(const PreparedScene& scene, const Backend& backend, const std::string& backend_name,
                         const Integrator& integrator, const Provenance& provenance) {
  TraceHeader header;
  header.creator_version = build_info().version;
  header.scene_json = scene.spec.source;
  header.provenance_json = provenance_text(provenance);
  header.backend = backend_name + " on " + backend.device();
  header.integrator = integrator.name;
  header.dt_s = scene.dt_s;
  return header;
}

}  // namespace mssim
