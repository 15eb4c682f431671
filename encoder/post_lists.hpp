// Which posts lie in which triangle: a linked list for each.
#ifndef MICROTIN_ENCODER_POST_LISTS_HPP
#define MICROTIN_ENCODER_POST_LISTS_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/mesh.hpp"

namespace microtin {

class PostLists {
 public:
  static constexpr uint32_t kEnd = ~uint32_t{0};

  explicit PostLists(std::size_t posts) : next_(posts) {}

  void set_triangles(std::size_t triangles) { first_.resize(triangles, kEnd); }

  uint32_t first(Index triangle) const { return first_[triangle]; }
  uint32_t next(uint32_t post) const { return next_[post]; }

  void push(Index triangle, uint32_t post) {
    next_[post] = first_[triangle];
    first_[triangle] = post;
  }

  // Empties the triangle's list and appends its posts to `posts`.
  void take(Index triangle, std::vector<uint32_t>& posts) {
    for (uint32_t p = first_[triangle]; p != kEnd; p = next_[p]) posts.push_back(p);
    first_[triangle] = kEnd;
  }

 private:
  std::vector<uint32_t> first_;  // by triangle
  std::vector<uint32_t> next_;   // by post
};

}  // namespace microtin

#endif
