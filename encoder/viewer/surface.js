// SPDX-License-Identifier: MIT
// What is drawn of a mesh beside its triangles: normals and edges.

// Calls visit(corners, normal) for each triangle; the normal points up and is twice as long as the area.
function forEachNormal({ positions, indices }, [gx, gy], visit) {
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [3 * indices[t], 3 * indices[t + 1], 3 * indices[t + 2]];
    const bx = (positions[b] - positions[a]) * gx, by = (positions[b + 1] - positions[a + 1]) * gy;
    const cx = (positions[c] - positions[a]) * gx, cy = (positions[c + 1] - positions[a + 1]) * gy;
    const bz = positions[b + 2] - positions[a + 2], cz = positions[c + 2] - positions[a + 2];
    visit(a, b, c, by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx);
  }
}

// The normal of each vertex, of any length, with heights scaled.
export function normalsOf(mesh, ground, scale) {
  const normals = new Float32Array(mesh.positions.length);
  forEachNormal(mesh, ground, (a, b, c, x, y, z) => {
    for (const v of [a, b, c]) {
      normals[v] += scale * x;
      normals[v + 1] += scale * y;
      normals[v + 2] += z;
    }
  });
  for (let v = 0; v < normals.length; v += 3) {
    const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
    for (let i = 0; i < 3; ++i) normals[v + i] /= length;
  }
  return normals;
}

// Both ends of each edge, and of those at the rim, which have a triangle on one side only.
export function edgesOf(indices) {
  const edges = [];
  const open = new Map();
  for (let t = 0; t < indices.length; t += 3) {
    for (let i = 0; i < 3; ++i) {
      const a = indices[t + i], b = indices[t + ((i + 1) % 3)];
      const key = Math.min(a, b) * 16777216 + Math.max(a, b); // below 2^53
      if (open.delete(key)) continue;
      open.set(key, edges.length);
      edges.push(a, b);
    }
  }
  const rims = [...open.values()].flatMap((at) => [edges[at], edges[at + 1]]);
  return { edges: Uint32Array.from(edges), rims: Uint32Array.from(rims) };
}
