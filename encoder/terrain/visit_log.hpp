// SPDX-License-Identifier: MIT
// Posts visited by several threads, told in one order.
#ifndef MICROTIN_ENCODER_TERRAIN_VISIT_LOG_HPP
#define MICROTIN_ENCODER_TERRAIN_VISIT_LOG_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::terrain {

class VisitLog {
 public:
  // Writes down posts whose places count from (x, y); the log must outlive it.
  PostVisitor recorder(int64_t x, int64_t y) {
    return [this, x, y](int64_t dx, int64_t dy, int64_t z, double above) {
      posts_.push_back({x + dx, y + dy, z, above});
    };
  }

  void tell(const PostVisitor& visit) const {
    for (const Post& post : posts_) visit(post.x, post.y, post.z, post.above);
  }

 private:
  struct Post {
    int64_t x, y, z;
    double above;
  };

  std::vector<Post> posts_;
};

}  // namespace microtin::terrain

#endif
