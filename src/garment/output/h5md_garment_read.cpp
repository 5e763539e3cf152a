#include "garment/output/h5md_garment_read.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "garment/output/h5md_garment.h"
#include "hdf5/hdf5.h"
#include "hdf5/hdf5_table.h"

namespace mssim {
namespace {

void read_panels(hid_t file, Garment& garment) {
  const std::string path = "/parameters/panels";
  for (std::string& name : read_texts(file, path + "/name")) garment.panels.push_back({std::move(name)});
  for (const auto& [name, member] :
       {std::pair{"/rows", &GarmentPanel::rows}, std::pair{"/columns", &GarmentPanel::columns},
        std::pair{"/first_node", &GarmentPanel::first_node}, std::pair{"/layer", &GarmentPanel::layer}}) {
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

Garment read_garment(hid_t file, std::size_t nodes) {
  Garment garment;
  read_panels(file, garment);
  const std::string flat = "/parameters/panels/flat";
  const std::vector<double> numbers = read_doubles(file, flat, {nodes, 2});
  for (std::size_t i = 0; i < nodes; ++i) {
    garment.flat.push_back({numbers[2 * i], numbers[2 * i + 1], 0});
    if (!is_finite(garment.flat.back()))
      throw Hdf5ContentError(flat + " has a number that is not finite, of node " + std::to_string(i));
  }
  read_joints(file, garment);
  require_fitting_garment(garment, nodes);
  return garment;
}

}  // namespace mssim
