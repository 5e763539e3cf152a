#include "output/traces/trace_reader.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "hdf5/hdf5.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {

namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = "give a whole trace that mssim run --trace wrote";

std::string sentence(const fs::path& file, const std::string& problem, const std::string& what_to_do) {
  return printable(file.string(), 1000) + ": " + printable(problem, 500) + ": " + what_to_do;
}

/// Runs what reads, and says of every failure which file it is and what to do.
template <class Read>
auto explained(const fs::path& file, const Read& read) {
  try {
    return read();
  } catch (const Hdf5Error& error) {
    const bool refused = error.error_number != 0;
    throw TraceError(sentence(file, error.action + " failed (" + error.what() + ")",
                              refused ? "check the file, its permissions and its disk" : remedy),
                     refused);
  } catch (const Hdf5ContentError& error) {
    throw TraceError(sentence(file, error.what(), remedy), false);
  } catch (const std::invalid_argument& error) {
    throw TraceError(sentence(file, error.what(), remedy), false);
  }
}

/// Throws unless there is such a file, and it is not the XDMF beside a trace.
void require_file(const fs::path& file) {
  if (file.extension() == ".xdmf") {
    const fs::path trace = fs::path(file).replace_extension(".h5");
    throw TraceError(sentence(file, "this describes a trace to viewers",
                              "give the trace, " + printable(trace.string(), 1000)),
                     false);
  }
  try {
    require_regular_file(file);
  } catch (const ReadError& error) {
    throw TraceError(error.sentence(file, "give the name of a trace, NAME.h5"),
                     error.cause == ReadError::Cause::other);
  }
}

}  // namespace

TraceReader::TraceReader(fs::path file) : name_(std::move(file)) {
  require_file(name_);
  // Some damage makes HDF5 1.10 crash where it opens a dataset, before anything of it can be checked.
  constexpr unsigned most_seconds = 60;
  if (!ends_in_trial([this] { open(); }, most_seconds))
    throw TraceError(sentence(name_, "the HDF5 library crashes on it", remedy), false);
  explained(name_, [this] { open(); });
}

void TraceReader::open() {
  file_ = open_for_reading(name_);
  content_ = read_trace_content(file_.get());
  const std::vector<hsize_t> extents{Hdf5Table::any, content_.nodes, 3};
  for (auto& [series, what] : {std::pair{&position_, "/position"}, std::pair{&velocity_, "/velocity"}}) {
    series->emplace(file_.get(), particles_group(content_) + what + "/value", extents);
    (*series)->require_stored(0, frames());
  }
}

std::vector<Vec3d> TraceReader::vectors(const Hdf5Table& series, const std::string& what,
                                        std::size_t frame) const {
  if (frame >= frames()) throw std::out_of_range("a trace has no such frame");
  return explained(name_, [&] {
    const std::vector<double> numbers = series.doubles(frame, 1);
    std::vector<Vec3d> vectors(content_.nodes);
    for (std::size_t node = 0; node < vectors.size(); ++node) {
      vectors[node] = {numbers[3 * node], numbers[3 * node + 1], numbers[3 * node + 2]};
      if (!is_finite(vectors[node]))
        throw Hdf5ContentError("the " + what + " of node " + std::to_string(node) + " in frame " +
                               std::to_string(frame) + " is not finite");
    }
    return vectors;
  });
}

std::optional<std::vector<double>> TraceReader::observable(std::string_view name) const {
  const std::string path = "/observables/" + std::string(name) + "/value";
  return explained(name_, [&]() -> std::optional<std::vector<double>> {
    if (!exists(file_.get(), path)) return std::nullopt;
    std::vector<double> numbers = Hdf5Table(file_.get(), path, {Hdf5Table::any}).doubles(0, frames());
    if (!std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); }))
      throw Hdf5ContentError(path + " has a number that is not finite");
    return numbers;
  });
}

}  // namespace mssim
