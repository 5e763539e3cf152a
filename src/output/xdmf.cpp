#include "output/xdmf.h"

#include <array>
#include <charconv>

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

/// The shortest text that reads back as the same number, in any locale.
std::string exact(double value) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

std::string data_item(const std::string& trace, const std::string& shape, std::string_view vector,
                      std::size_t frame) {
  return "<DataItem Dimensions=\"" + shape + " 3\" NumberType=\"Float\" Precision=\"4\" Format=\"HDF\">" +
         trace + ":" + xdmf_dataset(vector, frame) + "</DataItem>";
}

}  // namespace

std::string xdmf_dataset(std::string_view vector, std::size_t frame) {
  constexpr std::size_t digits = 6;  // so that viewers list the frames in order
  std::string number = std::to_string(frame);
  if (number.size() < digits) number.insert(0, digits - number.size(), '0');
  return "/xdmf/" + std::string(vector) + "/" + number;
}

void map_frames_for_xdmf(hid_t trace, const GridPatch& grid, std::size_t frames) {
  const std::string action = "mapping frames for XDMF";
  constexpr hsize_t dimensions = 3;
  const std::array<hsize_t, 3> all{frames, grid.nodes(), dimensions}, one{1, grid.nodes(), dimensions};
  const std::array<hsize_t, 4> surface{1, grid.rows, grid.columns, dimensions};
  const Hdf5Space target(H5Screate_simple(4, surface.data(), nullptr), action);
  const Hdf5Space source(H5Screate_simple(3, all.data(), nullptr), action);
  create_group(trace, "/xdmf");
  for (const std::string vector : {"position", "velocity"}) {
    create_group(trace, "/xdmf/" + vector);
    const std::string values = "/particles/cloth/" + vector + "/value";
    for (std::size_t frame = 0; frame < frames; ++frame) {
      const std::array<hsize_t, 3> start{frame, 0, 0};
      const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), action);
      checked(H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, one.data(), nullptr),
              action);
      // "." is the very file, whatever its name.
      checked(H5Pset_virtual(properties.get(), target.get(), ".", values.c_str(), source.get()), action);
      create_dataset(trace, xdmf_dataset(vector, frame), H5T_IEEE_F32LE, surface, false, properties)
          .close(action);
    }
  }
}

std::filesystem::path xdmf_of(const std::filesystem::path& trace) {
  return std::filesystem::path(trace).replace_extension(".xdmf");
}

void write_xdmf(const std::filesystem::path& trace, const GridPatch& grid, std::span<const double> times_s) {
  const std::string name = escape_xml(trace.filename().string());
  const std::string shape = "1 " + std::to_string(grid.rows) + " " + std::to_string(grid.columns);
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"trace\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t frame = 0; frame < times_s.size(); ++frame) {
    text += "      <Grid Name=\"cloth\" GridType=\"Uniform\">\n";
    text += "        <Time Value=\"" + exact(times_s[frame]) + "\"/>\n";
    text += "        <Topology TopologyType=\"3DSMesh\" Dimensions=\"" + shape + "\"/>\n";
    text += "        <Geometry GeometryType=\"XYZ\">" + data_item(name, shape, "position", frame) +
            "</Geometry>\n";
    text += "        <Attribute Name=\"velocity\" AttributeType=\"Vector\" Center=\"Node\">" +
            data_item(name, shape, "velocity", frame) + "</Attribute>\n";
    text += "      </Grid>\n";
  }
  text +=
      "    </Grid>\n"
      "  </Domain>\n"
      "</Xdmf>\n";
  write_file_atomically(xdmf_of(trace), text);
}

}  // namespace mssim
