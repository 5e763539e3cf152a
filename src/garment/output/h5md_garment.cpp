#include "garment/output/h5md_garment.h"

#include <fmt/core.h>

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
  std::vector<Number> numbers;
  numbers.reserve(items.size());
  for (const Item& item : items) numbers.push_back(item.*member);
  write_array(file, path, file_type, memory_type, std::array<hsize_t, 1>{numbers.size()}, numbers.data());
}

constexpr std::array panel_numbers{
    std::pair{"/rows", &GarmentPanel::rows}, std::pair{"/columns", &GarmentPanel::columns},
    std::pair{"/first_node", &GarmentPanel::first_node}, std::pair{"/layer", &GarmentPanel::layer}};

void read_panels(hid_t file, Garment& garment) {
  const std::string path = "/parameters/panels";
  for (std::string& name : read_texts(file, path + "/name")) garment.panels.push_back({std::move(name)});
  for (const auto& [name, member] : panel_numbers) {
    const std::vector<std::uint32_t> numbers = read_numbers(file, path + name, {garment.panels.size()});
    for (std::size_t i = 0; i < numbers.size(); ++i) garment.panels[i].*member = numbers[i];
  }
}

void read_joints(hid_t file, Garment& garment) {
  const std::string joints = "/connectivity/joints", path = "/parameters/joints";
  if (!exists(file, joints)) return;
  garment.seams = read_texts(file, "/parameters/seams");
  const std::vector<std::uint32_t> nodes = read_numbers(file, joints, {Hdf5Table::any, 3});
  const std::size_t count = nodes.size() / 3;
  const std::vector<double> edge_share = read_doubles(file, path + "/edge_share", {count});
  const std::vector<std::uint32_t> seam = read_numbers(file, path + "/seam", {count});
  for (std::size_t i = 0; i < count; ++i) {
    if (!(edge_share[i] >= 0 && edge_share[i] <= 1))
      throw Hdf5ContentError(path + "/edge_share has a number that is not between 0 and 1");
    Joint joint;
    joint.node = nodes[3 * i];
    joint.edge_first = nodes[3 * i + 1];
    joint.edge_second = nodes[3 * i + 2];
    joint.edge_share = edge_share[i];
    joint.seam = seam[i];
    garment.joints.push_back(joint);
  }
}

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
  std::vector<std::array<double, 2>> flat;
  for (const Vec3d& node : garment.flat) flat.push_back({node.x, node.y});
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
  std::vector<std::array<std::uint32_t, 3>> tuples;
  tuples.reserve(garment.joints.size());
  for (const Joint& joint : garment.joints)
    tuples.push_back({joint.node, joint.edge_first, joint.edge_second});
  write_tuples<3>(file, "/connectivity/joints", particles, tuples);
}

Garment read_garment(hid_t file, std::size_t nodes) {
  Garment garment;
  read_panels(file, garment);
  const std::string flat = "/parameters/panels/flat";
  const std::vector<double> numbers = read_doubles(file, flat, {nodes, 2});
  for (std::size_t i = 0; i < nodes; ++i) {
    garment.flat.push_back({numbers[2 * i], numbers[2 * i + 1], 0});
    if (!is_finite(garment.flat.back()))
      throw Hdf5ContentError(fmt::format("{} has a number that is not finite, for node {}", flat, i));
  }
  read_joints(file, garment);
  require_fitting_garment(garment, nodes);
  return garment;
}

}  // namespace mssim
