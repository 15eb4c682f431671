// SPDX-License-Identifier: MIT
// The layers of the encoder: a folder and a namespace each. A layer uses those above it in this
// list alone, and finds their names without saying whose they are. Two folders have the name of a
// keyword, so that their namespaces are called importing and exporting.
#ifndef MICROTIN_ENCODER_LAYERS_HPP
#define MICROTIN_ENCODER_LAYERS_HPP

namespace microtin {

// What every layer needs: errors that name their file, progress, work in parallel, text.
namespace base {}

// Numbers that are never rounded unnoticed: decimals, fractions, wide integers; units, and the way
// between the lattice and real coordinates.
namespace exact {
using namespace base;
}

// Reading and writing files: whole ones, pieces of large ones, outputs that appear complete or not
// at all.
namespace files {
using namespace exact;
}

// A terrain before it is a TIN: rasters and point clouds, what is known about them, their voids and
// water, how they lie on a lattice, and what a mesh makes of them.
namespace terrain {
using namespace files;
}

// Terrains out of the formats of other programs.
namespace importing {
using namespace terrain;
}

// A TIN as a stream and back: the triangulation, the order of the vertices, the coding, the header.
namespace stream {
using namespace importing;
}

// Which vertices, and which heights: the fewest bytes that keep a bound.
namespace fit {
using namespace stream;
}

// Large terrains in tiles that are decoded one by one: how they are cut, encoded, joined and read.
namespace pack {
using namespace fit;
}

// Decoded terrains in formats that other programs read.
namespace exporting {
using namespace pack;
}

// Decoded terrains as pictures: reliefs, and maps of their errors.
namespace picture {
using namespace exporting;
}

// The encoder as a library: terrain in, verified stream or pack and report out; and read back. What
// others use of it is in encoder/include, which is all that the folders gdal, python and qgis know.
namespace product {
using namespace picture;
}

// The command line: options in, reports out.
namespace cli {
using namespace product;
}

}  // namespace microtin

#endif
