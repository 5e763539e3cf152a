#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "model/system.h"
#include "platform/files.h"

namespace mssim {

/// The energy at one moment.
struct EnergySample {
  double time_s = 0;
  Energy energy;
};

/// A CSV file of samples with the columns time_s,kinetic_j,elastic_j,gravitational_j,total_j, the form that
/// scripts/check-energy reads. Numbers have ten significant digits: far finer than any tolerance a curve is
/// used with. Until close() the file is called NAME.part and has all samples so far, whatever ends the
/// process.
class EnergyCurve {
 public:
  /// Each line of `comment` stands before the header behind "# ". Throws WriteError, like AtomicFile.
  EnergyCurve(std::filesystem::path file, std::string_view comment);
  /// Without close(): gives up.
  ~EnergyCurve() { give_up(); }

  const std::filesystem::path& name() const { return file_.name(); }

  /// Throws WriteError, and std::invalid_argument for a time that does not increase and for numbers that are
  /// not finite; the samples before are then in NAME.part.
  void append(const EnergySample& sample);
  /// Gives the file its name. Throws WriteError.
  void close() { file_.move_into_place(); }
  /// Ends without giving the file its name; keeps NAME.part when it has samples. Returns how many.
  std::size_t give_up();

 private:
  AtomicFile file_;
  std::size_t samples_ = 0;
  double last_time_s_ = 0;
};

/// What is wrong with a trace's file name, and what to do about it; none where it is good: NAME.h5 of
/// characters that an XDMF file can name it with. Its readers take what follows a ':' for a dataset's path,
/// '|' for the end of a name, and '\' for a '/' or an escape; control characters and what is not UTF-8 make
/// no XML. The folder does not matter.
std::optional<std::string> trace_name_problem(const std::filesystem::path& trace);

}  // namespace mssim
