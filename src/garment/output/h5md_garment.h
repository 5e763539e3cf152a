#pragma once

#include <hdf5.h>

#include <cstddef>
#include <string>

#include "garment/garment.h"

namespace mssim {

/// What a trace says of a garment beside the nodes and springs of its panels:
///
///     /parameters/panels/name                 [panels] strings, as in the pattern
///     /parameters/panels/{rows,columns,first_node,layer}   [panels] uint32; nodes row by row, row 0 lowest
///     /parameters/panels/flat                 [nodes][2] float64: x and y in the pattern, m
///     /parameters/seams                       [seams] strings, where there are any
///     /connectivity/joints                    [joints][3] uint32: a node and the two ends of the edge to
///                                             which it is sewn, twice the same where that is a node
///     /parameters/joints/edge_share           [joints] float64, of the way from the first end to the second
///     /parameters/joints/seam                 [joints] uint32, index into /parameters/seams

/// Throws std::invalid_argument unless all nodes lie in the pattern, and joints join nodes for seams that
/// there are. The panels are left to require_fitting_shape (model/node_shape.h).
void require_fitting_garment(const Garment& garment, std::size_t nodes);

/// Writes panels, seams and the numbers of joints into /parameters, which exists. Throws Hdf5Error.
void write_garment(hid_t file, const Garment& garment);

/// Writes the joints into /connectivity, which exists. Throws Hdf5Error.
void write_joints(hid_t file, const std::string& particles, const Garment& garment);

/// Reads what these two write: panels, seams and joints. How the garment was dressed, and the length
/// and strength of joints, are not in a trace. Throws Hdf5Error, Hdf5ContentError, and std::invalid_argument
/// where the garment does not fit the nodes.
Garment read_garment(hid_t file, std::size_t nodes);

}  // namespace mssim
