// SPDX-License-Identifier: MIT
// The layers of the encoder: a folder and a namespace each. A layer includes exactly the layers
// that it lists here, all of which stand above it; tests/includes checks that. Two folders have the
// name of a keyword and one that of its function, so their namespaces are called importing,
// exporting and verifying.
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
using namespace base;
}

// A terrain before it is a TIN: rasters and point clouds, what is known about them, their voids and
// water, how they lie on a lattice, and what a mesh holds.
namespace terrain {
using namespace base;
using namespace exact;
}  // namespace terrain

// Terrains out of the formats of other programs.
namespace importing {
using namespace base;
using namespace exact;
using namespace files;
using namespace terrain;
}  // namespace importing

// A TIN as a stream and back: the triangulation, the order of the vertices, the coding, the header.
namespace stream {
using namespace base;
using namespace exact;
using namespace terrain;
}  // namespace stream

// Comparing a decoded terrain with its source: at posts and points, everywhere between, and water.
namespace verifying {
using namespace base;
using namespace exact;
using namespace terrain;
}  // namespace verifying

// Which vertices, and which heights: the fewest bytes that keep a bound.
namespace fit {
using namespace base;
using namespace exact;
using namespace terrain;
using namespace stream;
}  // namespace fit

// Large terrains in tiles that are decoded one by one: how they are cut, encoded, joined and read.
namespace pack {
using namespace base;
using namespace exact;
using namespace files;
using namespace terrain;
using namespace stream;
using namespace verifying;
using namespace fit;
}  // namespace pack

// Decoded terrains in formats that other programs read.
namespace exporting {
using namespace base;
using namespace exact;
using namespace files;
using namespace terrain;
using namespace importing;
using namespace stream;
using namespace verifying;
using namespace pack;
}  // namespace exporting

// Decoded terrains as pictures: reliefs, and maps of their errors.
namespace picture {
using namespace base;
using namespace exact;
using namespace terrain;
using namespace stream;
using namespace verifying;
using namespace exporting;
}  // namespace picture

// The encoder as a library: terrain in, verified stream or pack and report out; and read back. What
// others use of it is in encoder/include, which is all that the folders gdal, python and qgis know.
namespace product {
using namespace base;
using namespace exact;
using namespace files;
using namespace terrain;
using namespace importing;
using namespace stream;
using namespace verifying;
using namespace fit;
using namespace pack;
using namespace exporting;
}  // namespace product

// The command line: options in, reports out.
namespace cli {
using namespace base;
using namespace exact;
using namespace files;
using namespace terrain;
using namespace importing;
using namespace stream;
using namespace verifying;
using namespace exporting;
using namespace picture;
using namespace product;
}  // namespace cli

}  // namespace microtin

#endif
