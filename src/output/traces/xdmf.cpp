#include <fmt/format.h>

#include <array>
#include <functional>
#include <numeric>

#include "hdf5/hdf5.h"
#include "output/traces/h5md_trace.h"
#include "platform/files.h"
#include "text/text.h"

namespace mssim {
namespace {

/// The group of a part's virtual datasets or, of `panel`, a dataset: the panel's number at each node,
/// [1][rows][columns] int32.
std::string folder_of(std::string_view vector, const XdmfPart& part) {
  const std::string folder = "/xdmf/" + std::string(vector);
  return part.panel ? fmt::format("{}/{}", folder, *part.panel) : folder;
}
/// The same at each point of the body.
constexpr const char* panel_dataset_of_body = "/xdmf/panel/body";

/// The extents, separated by blanks.
std::string dimensions_of(std::span<const hsize_t> shape) { return fmt::format("{}", fmt::join(shape, " ")); }

/// A dataset of the trace in XDMF; `number` is the name of its type, of `bytes` bytes.
std::string data_item(const std::string& trace, const std::string& dataset, const std::string& shape,
                      std::string_view number, std::size_t bytes = sizeof(float)) {
  return fmt::format(
      R"(<DataItem Dimensions="{}" NumberType="{}" Precision="{}" Format="HDF">{}:{}</DataItem>)", shape,
      number, bytes, trace, dataset);
}

/// Cells between the nodes; `dataset` lists their corners.
std::string cells(const std::string& trace, std::string_view type, hsize_t count, const char* dataset,
                  int corners) {
  return fmt::format("<Topology TopologyType=\"{}\" NumberOfElements=\"{}\">{}</Topology>", type, count,
                     data_item(trace, dataset, fmt::format("{} {}", count, corners), "UInt"));
}

std::string topology_element(const std::string& trace, const XdmfMesh& mesh, const XdmfPart& part) {
  if (mesh.tetrahedra > 0) return cells(trace, "Tetrahedron", mesh.tetrahedra, tetrahedra_dataset, 4);
  return fmt::format("<Topology TopologyType=\"3DSMesh\" Dimensions=\"{}\"/>", dimensions_of(part.shape));
}

std::string geometry(const std::string& points) {
  return fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>", points);
}

/// Values at the nodes; `type` is Scalar or Vector.
std::string attribute(const std::string& name, const std::string& type, const std::string& values) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>", name, type,
                     values);
}

/// One mesh of these elements.
std::string uniform_grid(const std::string& indent, const std::string& name,
                         const std::vector<std::string>& elements) {
  std::string text = indent + "<Grid Name=\"" + xml_text(printable(name)) + "\" GridType=\"Uniform\">\n";
  for (const std::string& element : elements) text.append(indent).append("  ").append(element).append("\n");
  return text + indent + "</Grid>\n";
}

std::vector<std::string> part_elements(const std::string& trace, const XdmfMesh& mesh, const XdmfPart& part,
                                       std::size_t frame) {
  const std::string shape = dimensions_of(part.shape);
  const auto vectors = [&](std::string_view vector) {
    return data_item(trace, xdmf_dataset(vector, part, frame), shape + " 3", "Float",
                     mesh.bytes_per_number());
  };
  std::vector<std::string> elements{topology_element(trace, mesh, part), geometry(vectors("position")),
                                    attribute("velocity", "Vector", vectors("velocity"))};
  if (part.panel)
    elements.push_back(
        attribute("panel", "Scalar", data_item(trace, folder_of("panel", part), shape, "Int")));
  return elements;
}

std::vector<std::string> body_elements(const std::string& trace, const XdmfMesh& mesh) {
  const std::string points = std::to_string(mesh.body_points);
  return {cells(trace, "Triangle", mesh.body_triangles, body_triangles_dataset, 3),
          geometry(data_item(trace, body_points_dataset, points + " 3", "Float")),
          attribute("panel", "Scalar", data_item(trace, panel_dataset_of_body, points, "Int"))};
}

/// Everything that a frame shows: one grid, or a collection of named grids.
std::string frame_grids(const std::string& trace, const XdmfMesh& mesh, double time_s, std::size_t frame) {
  const std::string outer(6, ' '), inner(8, ' ');
  const std::string time = "<Time Value=\"" + decimal(time_s) + "\"/>";
  const XdmfPart& first = mesh.parts.front();
  if (!first.panel) {
    std::vector<std::string> elements = part_elements(trace, mesh, first, frame);
    elements.insert(elements.begin(), time);
    return uniform_grid(outer, first.name, elements);
  }
  std::string text = outer + "<Grid Name=\"" + std::string(mesh.particles) +
                     "\" GridType=\"Collection\" CollectionType=\"Spatial\">\n" + inner + time + "\n";
  for (const XdmfPart& part : mesh.parts)
    text += uniform_grid(inner, part.name, part_elements(trace, mesh, part, frame));
  if (mesh.body_triangles > 0) text += uniform_grid(inner, "body", body_elements(trace, mesh));
  return text + outer + "</Grid>\n";
}

/// Writes a dataset with one number everywhere.
void write_constant(hid_t file, const std::string& path, std::span<const hsize_t> shape,
                    std::int32_t number) {
  const std::string action = "writing " + path;
  const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), action);
  checked(H5Pset_fill_value(properties.get(), H5T_NATIVE_INT32, &number), action);
  create_dataset(file, path, H5T_STD_I32LE, shape, properties).close(action);
}

/// The datasets of panels' numbers consist of their fill value and take no space.
void number_panels_for_xdmf(hid_t trace, const XdmfMesh& mesh) {
  create_group(trace, "/xdmf/panel");
  for (const XdmfPart& part : mesh.parts)
    write_constant(trace, folder_of("panel", part), part.shape, part.panel.value());
  if (mesh.body_triangles > 0) write_constant(trace, panel_dataset_of_body, std::array{mesh.body_points}, -1);
}

}  // namespace

XdmfMesh xdmf_mesh_of(const NodeShape& shape, std::size_t nodes, const Surface& body, bool in_double) {
  XdmfMesh mesh{shape.kind,           nodes, {}, in_double, shape.tetrahedra.size(), body.points.size(),
                body.triangles.size()};
  for (const GarmentPanel& sheet : shape.sheets) {
    XdmfPart part{sheet.name, {}, sheet.first_node, {1, sheet.rows, sheet.columns}};
    if (shape.in_panels) part.panel = static_cast<std::int32_t>(mesh.parts.size());
    mesh.parts.push_back(std::move(part));
  }
  if (shape.sheets.empty()) mesh.parts.push_back({std::string(shape.kind), {}, 0, {nodes}});
  return mesh;
}

std::string xdmf_dataset(std::string_view vector, const XdmfPart& part, std::size_t frame) {
  constexpr std::size_t digits = 6;  // so that viewers sort the frames
  return fmt::format("{}/{:0{}}", folder_of(vector, part), frame, digits);
}

void map_frames_for_xdmf(hid_t trace, const XdmfMesh& mesh, std::size_t frames) {
  const std::string action = "mapping frames for XDMF";
  constexpr hsize_t axes = 3;
  const std::array<hsize_t, 3> all{frames, mesh.nodes, axes};
  const hid_t type = mesh.in_double ? H5T_IEEE_F64LE : H5T_IEEE_F32LE;
  const Hdf5Space source(H5Screate_simple(3, all.data(), nullptr), action);
  create_group(trace, "/xdmf");
  if (mesh.parts.front().panel) number_panels_for_xdmf(trace, mesh);
  for (const std::string vector : {"position", "velocity"}) {
    create_group(trace, "/xdmf/" + vector);
    const std::string values = fmt::format("/particles/{}/{}/value", mesh.particles, vector);
    for (const XdmfPart& part : mesh.parts) {
      if (part.panel) create_group(trace, folder_of(vector, part));
      std::vector<hsize_t> shape = part.shape;
      const hsize_t nodes = std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
      shape.push_back(axes);
      const std::array<hsize_t, 3> count{1, nodes, axes};
      const Hdf5Space target(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), action);
      for (std::size_t frame = 0; frame < frames; ++frame) {
        const std::array<hsize_t, 3> start{frame, part.first_node, 0};
        const Hdf5Properties properties(H5Pcreate(H5P_DATASET_CREATE), action);
        checked(
            H5Sselect_hyperslab(source.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
            action);
        // "." is this file, whatever its name.
        checked(H5Pset_virtual(properties.get(), target.get(), ".", values.c_str(), source.get()), action);
        create_dataset(trace, xdmf_dataset(vector, part, frame), type, shape, properties).close(action);
      }
    }
  }
}

std::optional<std::string> trace_name_problem(const std::filesystem::path& trace) {
  constexpr std::string_view misread = ":|\\";
  const std::string name = trace.filename().string();
  const std::string shown = '"' + printable(name) + '"';
  if (trace.extension() != ".h5")
    return shown + " is not a name of the form NAME.h5: give " +
           (name.empty() ? "a file in that folder" : printable(trace.stem().string()) + ".h5");
  if (const std::size_t at = name.find_first_of(misread); at != std::string::npos)
    return shown + " has a '" + name[at] +
           "', which readers of the XDMF file misread: give a name without it";
  if (escaped(name) != name)
    return shown +
           " has characters that are not printable, which an XDMF file cannot hold: give a name without them";
  if (name.front() == ' ' || trace.stem().string().back() == ' ')
    return shown +
           " begins or ends with a blank, which readers of the XDMF file drop: give a name without it";
  return std::nullopt;
}

std::filesystem::path xdmf_of(const std::filesystem::path& trace) {
  return std::filesystem::path(trace).replace_extension(".xdmf");
}

void write_xdmf(const std::filesystem::path& trace, const XdmfMesh& mesh, std::span<const double> times_s) {
  std::string name = xml_text(trace.filename().string());
  // VTK drops bytes outside ASCII before a name, like blanks, and then finds no file.
  constexpr unsigned char last_ascii = 0x7f;
  if (static_cast<unsigned char>(name.front()) > last_ascii) name.insert(0, "./");
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<Xdmf Version=\"3.0\">\n"
      "  <Domain>\n"
      "    <Grid Name=\"trace\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (std::size_t frame = 0; frame < times_s.size(); ++frame)
    text += frame_grids(name, mesh, times_s[frame], frame);
  text +=
      "    </Grid>\n"
      "  </Domain>\n"
      "</Xdmf>\n";
  write_file_atomically(xdmf_of(trace), text);
}

}  // namespace mssim
