#include "output/xdmf.h"

#include <array>
#include <functional>
#include <numeric>

#include "model/decimal.h"
#include "output/atomic_file.h"
#include "output/hdf5_write.h"

namespace mssim {
namespace {

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (const char character : text) switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += character;
    }
  return escaped;
}

/// The extents, separated by blanks.
std::string dimensions_of(std::span<const hsize_t> shape) {
  std::string text;
  for (const hsize_t extent : shape) text.append(text.empty() ? "" : " ").append(std::to_string(extent));
  return text;
}

/// A dataset of the trace as XDMF names it; `number` is its type's name.
std::string data_item(const std::string& trace, const std::string& dataset, const std::string& dimensions,
                      std::string_view number) {
  std::string item = "<DataItem Dimensions=\"" + dimensions + "\" NumberType=\"";
  item += number;
  return item + "\" Precision=\"4\" Format=\"HDF\">" + trace + ":" + dataset + "</DataItem>";
}

std::string topology_element(const std::string& trace, const XdmfMesh& mesh) {
  if (mesh.tetrahedra == 0)
    return "<Topology TopologyType=\"3DSMesh\" Dimensions=\"" + dimensions_of(mesh.shape) + "\"/>";
  const std::string count = std::to_string(mesh.tetrahedra);
  return "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"" + count + "\">" +
         data_item(trace, tetrahedra_dataset, count + " 4", "UInt") + "</Topology>";
}

}  // namespace

XdmfMesh xdmf_mesh_of(const System& system) {
  if (const auto* grid = std::get_if<GridPatch>(&system.topology))
    return {"cloth", {1, grid->rows, grid->columns}, 0};
  return {"bodies", {system.nodes()}, std::get<TetrahedralMesh>(system.topology).tetrahedra.size()};
}

std::string xdmf_dataset(std::string_view vector, std::size_t frame) {
  constexpr std::size_t digits = 6;  // so that viewers list the frames in order
  std::string number = std::to_string(frame);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return "/xdmf/" + std::string(vector) + "/" + number;
}

void map_frames_for_xdmf(hid_t trace, const XdmfMesh& mesh, std::size_t frames) {
  const std::string action = "mapping frames for XDMF";
  constexpr hsize_t dimensions = 3;
  std::vector<hsize_t> shape = mesh.shape;
  const hsize_t nodes = std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
  shape.push_back(dimensions);
  const std::array<hsize_t, 3> all{frames, nodes, dimensions}, one{1, nodes, dimensions};
  const Hdf5Space target(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), action);
  const Hdf5Space source(H5Screate_simple(3, all.data(), nullptr), action);
  create_group(trace, "/xdmf");
  for (const std::string vector : {"position", "velocity"}) {
    create_group(trace, "/xdmf/" + vector);
    const std::string values = "/particles/" + mesh.particles + "/" + vector + "/value";
    for (std::size_t frame = 0; frame < frames; ++frame) {
      const std::array<hsize_t, 3> start{frame, 0, 0};
      const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), action);
      checked(H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, one.data(), nullptr),
              action);
      // "." is the very file, whatever its name.
      checked(H5Pset_virtual(properties.get(), target.get(), ".", values.c_str(), source.get()), action);
      create_dataset(trace, xdmf_dataset(vector, frame), H5T_IEEE_F32LE, shape, false, properties)
          .close(action);
    }
  }
}

std::filesystem::path xdmf_of(const std::filesystem::path& trace) {
  return std::filesystem::path(trace).replace_extension(".xdmf");
}

void write_xdmf(const std::filesystem::path& trace, const XdmfMesh& mesh, std::span<const double> times_s) {
  const std::string name = escape_xml(trace.filename().string());
  const std::string topology = topology_element(name, mesh);
  const auto vectors = [&](std::string_view vector, std::size_t frame) {
    return data_item(name, xdmf_dataset(vector, frame), dimensions_of(mesh.shape) + " 3", "Float");
  };
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"trace\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t frame = 0; frame < times_s.size(); ++frame) {
    text += "      <Grid Name=\"" + mesh.particles + "\" GridType=\"Uniform\">\n";
    text += "        <Time Value=\"" + decimal(times_s[frame]) + "\"/>\n";
    text += "        " + topology + "\n";
    text += "        <Geometry GeometryType=\"XYZ\">" + vectors("position", frame) + "</Geometry>\n";
    text += "        <Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">" +
            vectors("velocity", frame) + "</Attribute>\n";
    text += "      </Grid>\n";
  }
  text +=
      "    </Grid>\n"
      "  </Domain>\n"
      "</Xdmf>\n";
  write_file_atomically(xdmf_of(trace), text);
}

}  // namespace mssim
