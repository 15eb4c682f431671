// SPDX-License-Identifier: MIT
// Wavefront OBJ: of its lines the vertices.
#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {

PointCloud import_obj(const std::string& name, const std::string& text) {
  PointColumns points;
  std::vector<std::string_view> fields;
  std::string_view rest = without_mark(text);
  for (size_t line = 1; !rest.empty(); ++line) {
    split_at_blanks(take_line(rest), fields);
    if (fields.empty() || fields[0] != "v") continue;
    if (fields.size() < 4) fail_at(name, line, "a vertex needs three numbers");
    for (size_t i = 1; i < fields.size(); ++i) {
      const std::optional<Decimal> value = parse_decimal(fields[i]);
      if (!value || (i <= 3 && !points.add(i - 1, *value))) {
        fail_at(name, line, not_a_number(fields[i]));
      }
    }
  }
  if (points.empty()) throw Error(name + ": holds no vertex");
  return points.take();
}

}  // namespace microtin::importing
