// SPDX-License-Identifier: MIT
// Changes of a surface that can be taken back.
#ifndef MICROTIN_ENCODER_FIT_EDITS_HPP
#define MICROTIN_ENCODER_FIT_EDITS_HPP

#include <cstddef>
#include <vector>

#include "encoder/fit/surface.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

class Edits {
 public:
  // The surface must outlive this; nobody else changes it meanwhile.
  explicit Edits(Surface& surface) : surface_(surface) {}

  // As those of Surface.
  bool remove(Index v);
  Index insert(Vertex vertex, Index hint);

  // False, and nothing changes, if the height does not fit 16 bits.
  bool set_height(Index v, int32_t height);

  // How many there are, and back to when there were so many.
  std::size_t size() const { return edits_.size(); }
  void roll_back(std::size_t size);

  // Keeps them all.
  void commit() { edits_.clear(); }

 private:
  struct Edit {
    enum Kind : uint8_t { kRemoval, kInsertion, kHeight } kind;
    Index vertex;
    Vertex before;
    Index neighbour;  // of a removed vertex
  };

  Surface& surface_;
  std::vector<Edit> edits_;
};

}  // namespace microtin::fit

#endif
