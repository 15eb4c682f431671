// SPDX-License-Identifier: MIT
// Where the time of encoding goes.
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/stream/order.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {

void print_encode_speed() {
  constexpr uint32_t kVertices = 1000000;
  const Tin tin = uniform_tin(kVertices, 0);
  std::vector<Point> points;
  for (const Vertex& v : tin.vertices) points.push_back({v.x, v.y});
  std::vector<Index> numbers;
  const Bytes stream = encode(tin, {});
  const std::optional<Triangulator> peer = triangulator();

  std::vector<Work> works = {
      [&] { Triangulation(points, numbers); },
      [&] {
        Triangulation triangulation(points, numbers);
        breadth_first_order(triangulation, usual_degree(Effort()));
      },
      [&] { encode(tin, {}); },
      [&] { DecodedTerrain{stream}; },
  };
  if (peer) works.push_back([&] { peer->count_triangles(tin.vertices); });
  const std::vector<double> times = nanoseconds(works);
  const double triangulation = times[0], ordered = times[1], encoded = times[2], check = times[3];

  print_head("Encoding 1,000,000 uniform points, seconds", {"step", "seconds"});
  const auto print = [](const std::string& step, double time) {
    print_row({step, number(time / 1e9, 2)});
  };
  print("triangulation", triangulation);
  print("ordering", ordered - triangulation);
  print("coding (encode without the other steps)", encoded - ordered - check);
  print("decoding the result as a check", check);
  if (peer) print(peer->name + ": triangulation", times[4]);
}

}  // namespace microtin::bench
