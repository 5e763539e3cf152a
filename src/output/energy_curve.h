#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "model/energy.h"

namespace mssim {

/// The energy at one moment.
struct EnergySample {
  double time_s = 0;
  Energy energy;
};

/// Writes the samples as CSV with the columns time_s,kinetic_j,elastic_j,gravitational_j,total_j, the form
/// that scripts/check-energy reads. Each line of `comment` stands before the header behind "# ". Numbers have
/// ten significant digits: far finer than any tolerance a curve is used with. Throws std::invalid_argument
/// for times that do not increase and for numbers that are not finite, WriteError when the file cannot be
/// written.
void write_energy_curve(const std::filesystem::path& file, std::span<const EnergySample> samples,
                        std::string_view comment);

}  // namespace mssim
