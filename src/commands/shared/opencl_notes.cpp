#include "commands/shared/opencl_notes.h"

#include <iostream>
#include <string>
#include <utility>

#include "backends/devices/offer.h"

namespace mssim {

void tell_of_opencl() {
  static bool told = false;
  if (std::exchange(told, true)) return;
  const OpenclOffer& offer = opencl_offer();
  for (const std::string& trouble : offer.troubles) std::cerr << "mssim: " << trouble << '\n';
  if (!offer.note.empty()) std::cerr << "mssim: " << offer.note << '\n';
}

}  // namespace mssim
