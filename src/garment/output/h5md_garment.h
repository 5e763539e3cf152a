#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "garment/garment.h"

namespace mssim {

/// The part of a trace that describes a garment, besides the nodes and springs of its panels:
///
///     /parameters/panels/name                 [panels] strings, as in the pattern
///     /parameters/panels/{rows,columns,first_node,layer}   [panels] uint32; nodes row by row, row 0 lowest
///     /parameters/panels/flat                 [nodes][2] float64: x and y in the pattern, m
///     /parameters/seams                       [seams] strings, if there are any
///     /connectivity/joints                    [joints][3] uint32: a node and the two ends of the edge to
///                                             which it is sewn, equal if it is sewn to a node
///     /parameters/joints/edge_share           [joints] float64, of the way from the first end to the second
///     /parameters/joints/seam                 [joints] uint32, index into /parameters/seams

/// Throws std::invalid_argument unless all nodes have a place in the pattern and joints refer to existing
/// nodes and seams. require_fitting_shape (model/node_shape.h) checks the panels.
void require_fitting_garment(const Garment& garment, std::size_t nodes);

/// Writes panels, seams and the numbers of joints into the existing group /parameters. Throws Hdf5Error.
void write_garment(hid_t file, const Garment& garment);

/// Writes the joints into the existing group /connectivity. Throws Hdf5Error.
void write_joints(hid_t file, const std::string& particles, const Garment& garment);

/// Reads the panels. Throws Hdf5Error and Hdf5ContentError.
std::vector<GarmentPanel> read_panels(hid_t file);

}  // namespace mssim
