#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

#include "model/system.h"
#include "platform/files.h"

namespace mssim {

/// The energy at one time.
struct EnergySample {
  double time_s = 0;
  Energy energy;
};

/// A CSV file of samples with the columns time_s,kinetic_j,elastic_j,gravitational_j,total_j, which
/// scripts/check-energy reads. Numbers have ten significant digits, far more than any tolerance for a curve
/// requires. Until close() the file is called NAME.part; it has all samples so far, however the process ends.
class EnergyCurve {
 public:
  /// Writes each line of `comment` before the header, after "# ". Throws WriteError, like AtomicFile.
  EnergyCurve(std::filesystem::path file, std::string_view comment);
  /// Without close(): gives up.
  ~EnergyCurve() { give_up(); }

  const std::filesystem::path& name() const { return file_.name(); }

  /// Throws WriteError; throws std::invalid_argument for a time that does not increase and for numbers that
  /// are not finite. NAME.part then has the earlier samples.
  void append(const EnergySample& sample);
  /// Gives the file its name. Throws WriteError.
  void close() { file_.move_into_place(); }
  /// Closes the file without giving it its name; keeps NAME.part if it has samples. Returns their number.
  std::size_t give_up();

 private:
  AtomicFile file_;
  std::size_t samples_ = 0;
  double last_time_s_ = 0;
};

}  // namespace mssim
