#include "garment/output/h5md_garment.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"
#include "text/text.h"

namespace mssim {
namespace {

/// Writes a list of numbers, one for each of `items`.
template <class Item, class Number>
void write_numbers(hid_t file, const std::string& path, const std::vector<Item>& items, Number Item::*member,
                   hid_t file_type, hid_t memory_type) {
  const auto numbers = mapped<Number>(items, member);
  write_array(file, path, file_type, memory_type, std::array<hsize_t, 1>{numbers.size()}, numbers.data());
}

constexpr std::array panel_numbers{
    std::pair{"/rows", &GarmentPanel::rows}, std::pair{"/columns", &GarmentPanel::columns},
    std::pair{"/first_node", &GarmentPanel::first_node}, std::pair{"/layer", &GarmentPanel::layer}};

}  // namespace

void require_fitting_garment(const Garment& garment, std::size_t nodes) {
  if (garment.flat.size() != nodes)
    throw std::invalid_argument("a trace of a garment needs the place of every node in the pattern");
  const bool joined = std::ranges::all_of(garment.joints, [&](const Joint& joint) {
    return std::max({joint.node, joint.edge_first, joint.edge_second}) < nodes &&
           joint.seam < garment.seams.size();
  });
  if (!joined) throw std::invalid_argument("a trace of a garment has a joint of a missing node or seam");
}

void write_garment(hid_t file, const Garment& garment) {
  const std::string panels = "/parameters/panels", joints = "/parameters/joints";
  create_group(file, panels);
  write_texts(file, panels + "/name", mapped<std::string_view>(garment.panels, &GarmentPanel::name));
  for (const auto& [name, member] : panel_numbers)
    write_numbers(file, panels + name, garment.panels, member, H5T_STD_U32LE, H5T_NATIVE_UINT32);
  const auto flat = mapped<std::array<double, 2>>(garment.flat, [](const Vec3d& node) {
    return std::array{node.x, node.y};
  });
  write_array(file, panels + "/flat", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE,
              std::array<hsize_t, 2>{flat.size(), 2}, flat.data());
  if (garment.joints.empty()) return;
  write_texts(file, "/parameters/seams",
              std::vector<std::string_view>(garment.seams.begin(), garment.seams.end()));
  create_group(file, joints);
  write_numbers(file, joints + "/edge_share", garment.joints, &Joint::edge_share, H5T_IEEE_F64LE,
                H5T_NATIVE_DOUBLE);
  write_numbers(file, joints + "/seam", garment.joints, &Joint::seam, H5T_STD_U32LE, H5T_NATIVE_UINT32);
}

void write_joints(hid_t file, const std::string& particles, const Garment& garment) {
  const auto tuples = mapped<std::array<std::uint32_t, 3>>(garment.joints, [](const Joint& joint) {
    return std::array{joint.node, joint.edge_first, joint.edge_second};
  });
  write_tuples<3>(file, "/connectivity/joints", particles, tuples);
}

std::vector<GarmentPanel> read_panels(hid_t file) {
  const std::string path = "/parameters/panels";
  std::vector<GarmentPanel> panels;
  for (std::string& name : read_texts(file, path + "/name")) panels.push_back({std::move(name)});
  for (const auto& [name, member] : panel_numbers) {
    const std::vector<std::uint32_t> numbers = read_numbers(file, path + name, {panels.size()});
    for (std::size_t i = 0; i < numbers.size(); ++i) panels[i].*member = numbers[i];
  }
  return panels;
}

}  // namespace mssim
