#pragma once
/// The order of nodes and cells in memory.
#include "fem/mesh/mesh.hpp"

namespace muldi::fem {

/// Numbers the nodes so that those of a cell are near each other (reverse Cuthill and McKee, each piece from a node at
/// its end), and the cells by their least node. All sets, labels and layers follow.
void order_by_neighbours(Mesh& mesh);

/// Largest difference of two node numbers of a cell.
int bandwidth(const Mesh& mesh);

}  // namespace muldi::fem
