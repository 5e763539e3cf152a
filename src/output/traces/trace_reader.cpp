#include "output/traces/trace_reader.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "garment/output/h5md_garment.h"
#include "platform/files.h"
#include "platform/process.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Reads steps and times. The shortest series counts: a run may have ended between writing two of them, or
/// between a frame's positions and its step.
void read_series(hid_t file, TraceContent& content) {
  const std::string position = particles_group(content) + "/position",
                    velocity = particles_group(content) + "/velocity";
  const Hdf5Table step(file, position + "/step", {Hdf5Table::any}),
      time(file, position + "/time", {Hdf5Table::any}),
      positions(file, position + "/value", {Hdf5Table::any, Hdf5Table::any, 3});
  const Hdf5Table velocities(file, velocity + "/value", {Hdf5Table::any, positions.extent(1), 3});
  const auto [fewest, most] = std::minmax({step.rows(), time.rows(), positions.rows(), velocities.rows()});
  if (most - fewest > 1)
    throw Hdf5ContentError(fmt::format(
        "steps, times, positions and velocities have different numbers of frames, {} to {}", fewest, most));
  if (fewest == 0) throw Hdf5ContentError("it has no frames");
  if (positions.extent(1) > std::numeric_limits<std::uint32_t>::max())
    throw Hdf5ContentError(position + "/value has more nodes than mssim can number");
  content.in_double = positions.bytes_per_number() == sizeof(double);
  content.nodes = positions.extent(1);
  content.step = step.read<std::int64_t>(0, fewest);
  content.time_s = time.read<double>(0, fewest);
  const bool finite =
      std::ranges::all_of(content.time_s, [](double time_s) { return std::isfinite(time_s); });
  if (!finite || std::ranges::adjacent_find(content.step, std::greater_equal<>()) != content.step.end() ||
      std::ranges::adjacent_find(content.time_s, std::greater_equal<>()) != content.time_s.end())
    throw Hdf5ContentError("its steps and times do not increase");
  // In H5MD, velocities may be sampled at other times than positions.
  const std::vector<hsize_t> list{Hdf5Table::any};
  if ((exists(file, velocity + "/step") &&
       Hdf5Table(file, velocity + "/step", list).read<std::int64_t>(0, fewest) != content.step) ||
      (exists(file, velocity + "/time") &&
       Hdf5Table(file, velocity + "/time", list).read<double>(0, fewest) != content.time_s))
    throw Hdf5ContentError(fmt::format("{} and {} have different steps or times", position, velocity));
}

/// Tuples of nodes; an empty list has no dataset.
template <std::size_t size>
std::vector<std::array<std::uint32_t, size>> read_tuples(hid_t file, const std::string& path) {
  std::vector<std::array<std::uint32_t, size>> tuples;
  if (!exists(file, path)) return tuples;
  const std::vector<std::uint32_t> numbers = read_numbers(file, path, {Hdf5Table::any, size});
  tuples.resize(numbers.size() / size);
  for (std::size_t i = 0; i < numbers.size(); ++i) tuples[i / size][i % size] = numbers[i];
  return tuples;
}

std::uint32_t read_extent(hid_t file, const std::string& name) {
  const std::int64_t extent = read_integer_attribute(file, "/parameters", name);
  if (extent < 1 || extent > std::numeric_limits<std::uint32_t>::max())
    throw Hdf5ContentError(fmt::format("attribute {} of /parameters is {}", name, extent));
  return static_cast<std::uint32_t>(extent);
}

NodeShape read_shape(hid_t file) {
  if (exists(file, "/particles/cloth"))
    return shape_of(GridPatch{read_extent(file, "rows"), read_extent(file, "columns")});
  if (exists(file, "/particles/bodies"))
    return shape_of(TetrahedralMesh{read_tuples<4>(file, tetrahedra_dataset)});
  if (exists(file, "/particles/garment")) return {"garment", read_panels(file), {}, true};
  throw Hdf5ContentError("there is none of /particles/cloth, /particles/bodies and /particles/garment");
}

void read_springs(hid_t file, TraceContent& content) {
  const std::string springs = "/connectivity/springs", rest_length = "/parameters/springs/rest_length";
  content.springs = read_tuples<2>(file, springs);
  for (const auto& [first, second] : content.springs)
    if (std::max(first, second) >= content.nodes || first == second)
      throw Hdf5ContentError(fmt::format("{} has a spring between the nodes {} and {} of {}", springs, first,
                                         second, content.nodes));
  if (content.springs.empty() || !exists(file, rest_length)) return;
  content.rest_length = read_doubles(file, rest_length, {content.springs.size()});
  for (const double length : content.rest_length)
    if (!(length > 0 && std::isfinite(length)))
      throw Hdf5ContentError(rest_length + " has a length that is not above 0");
}

Surface read_static_body(hid_t file) {
  Surface body;
  if (!exists(file, "/body")) return body;
  const std::vector<double> numbers = read_doubles(file, body_points_dataset, {Hdf5Table::any, 3});
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    body.points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    if (!is_finite(body.points.back()))
      throw Hdf5ContentError(std::string(body_points_dataset) + " has a number that is not finite");
  }
  body.triangles = read_tuples<3>(file, body_triangles_dataset);
  return body;
}

namespace fs = std::filesystem;

constexpr const char* remedy = "give a complete trace that mssim run --trace wrote";

std::string sentence(const fs::path& file, const std::string& problem, const std::string& what_to_do) {
  return fmt::format("{}: {}: {}", printable(file.string(), 1000), printable(problem, 500), what_to_do);
}

/// Runs `read`, and adds the file and the remedy to every failure.
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

/// Throws unless the file exists and is not the XDMF of a trace.
void require_file(const fs::path& file) {
  if (file.extension() == ".xdmf") {
    const fs::path trace = fs::path(file).replace_extension(".h5");
    throw TraceError(sentence(file, "this is the XDMF of a trace, for viewers",
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

TraceContent read_trace_content(hid_t file) {
  if (!exists(file, "/h5md")) throw Hdf5ContentError("it is an HDF5 file, but not an H5MD trace");
  TraceContent content;
  content.shape = read_shape(file);
  read_series(file, content);
  require_fitting_shape(content.shape, content.nodes);
  read_springs(file, content);
  content.body = read_static_body(file);
  require_fitting_body(content.shape, content.body);
  content.scene_json = read_text(file, "/parameters/scene");
  return content;
}

TraceContent trace_content_of(const System& system, const TraceHeader& header, const Surface& body) {
  TraceContent content;
  content.shape = shape_of(system.topology);
  for (const Spring& spring : system.springs) {
    content.springs.push_back({spring.first, spring.second});
    content.rest_length.push_back(spring.rest_length);
  }
  content.body = body;
  content.scene_json = header.scene_json;
  content.in_double = header.in_double;
  content.nodes = system.nodes();
  return content;
}

std::string particles_group(const TraceContent& content) {
  return "/particles/" + std::string(content.shape.kind);
}

std::vector<double> node_strain(const TraceContent& content, const std::vector<Vec3d>& positions) {
  if (!has_strain(content)) return std::vector(content.nodes, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> strain(content.nodes);
  std::vector<std::uint32_t> springs(content.nodes);
  for (std::size_t i = 0; i < content.rest_length.size(); ++i) {
    const auto& [first, second] = content.springs[i];
    const double rest = content.rest_length[i];
    if (rest <= 0) continue;
    const double stretched = length(positions[second] - positions[first]) / rest - 1;
    for (const std::uint32_t node : {first, second}) {
      strain[node] += stretched;
      ++springs[node];
    }
  }
  for (std::size_t node = 0; node < strain.size(); ++node)
    if (springs[node] > 0) strain[node] /= springs[node];
  return strain;
}

TraceReader::TraceReader(fs::path file) : name_(std::move(file)) {
  require_file(name_);
  // Some damage makes HDF5 1.10 crash when it opens a dataset, before anything of it can be checked.
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
    const std::vector<double> numbers = series.read<double>(frame, 1);
    std::vector<Vec3d> vectors(content_.nodes);
    for (std::size_t node = 0; node < vectors.size(); ++node) {
      vectors[node] = {numbers[3 * node], numbers[3 * node + 1], numbers[3 * node + 2]};
      if (!is_finite(vectors[node]))
        throw Hdf5ContentError(fmt::format("the {} of node {} in frame {} is not finite", what, node, frame));
    }
    return vectors;
  });
}

}  // namespace mssim
