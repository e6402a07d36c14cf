// A convex solid for drawing: flat-shaded triangles with outward normals, whatever the winding of the file, and the
// edges at which the surface turns by more than `crease` degrees.
function solid(mesh, crease = 12) {
  const count = mesh.v.length / 3;
  const at = (i) => [mesh.v[3 * i], mesh.v[3 * i + 1], mesh.v[3 * i + 2]];
  let centre = [0, 0, 0];
  for (let i = 0; i < count; i++) centre = add(centre, scale(at(i), 1 / count));
  const triangles = [];
  for (let k = 0; k < mesh.f.length; k += 3) {
    let corners = [mesh.f[k], mesh.f[k + 1], mesh.f[k + 2]];
    let [a, b, c] = corners.map(at);
    let n = cross(sub(b, a), sub(c, a));
    if (norm(n) === 0) continue;
    if (dot(n, sub(a, centre)) < 0) { n = scale(n, -1); corners = [corners[0], corners[2], corners[1]]; }
    triangles.push({ corners, points: corners.map(at), normal: unit(n) });
  }
  const position = new Float32Array(9 * triangles.length), normal = new Float32Array(9 * triangles.length);
  triangles.forEach((t, k) => t.points.forEach((p, j) => {
    position.set(p, 9 * k + 3 * j);
    normal.set(t.normal, 9 * k + 3 * j);
  }));
  const vertices = Array.from({ length: count }, (_, i) => at(i));
  return { triangles, position, normal, vertices, creases: lines(creases(triangles, crease)) };
}

function creases(triangles, degrees) {
  const limit = Math.cos(degrees * Math.PI / 180), seen = new Map(), found = [];
  for (const t of triangles) {
    for (let j = 0; j < 3; j++) {
      const a = t.corners[j], b = t.corners[(j + 1) % 3], key = a < b ? a + "," + b : b + "," + a;
      const other = seen.get(key);
      if (!other) seen.set(key, t.normal);
      else if (dot(other, t.normal) < limit) found.push([t.points[j], t.points[(j + 1) % 3]]);
    }
  }
  return found;
}

// Smooth shading for the true shape: each corner takes the mean normal of the faces around it.
function smooth(body) {
  const sums = body.vertices.map(() => [0, 0, 0]);
  for (const t of body.triangles) for (const c of t.corners) sums[c] = add(sums[c], t.normal);
  body.triangles.forEach((t, k) => t.corners.forEach((c, j) => body.normal.set(unit(sums[c]), 9 * k + 3 * j)));
  return body;
}

// Line segments from a list of polylines; `upTo[k]` is the number of segments among the first `k + 1` points of the
// first polyline, for drawing a trail up to a time.
function lines(polylines) {
  const segments = [], upTo = [];
  for (const line of polylines) {
    for (let i = 0; i < line.length; i++) {
      if (i > 0 && line[i] && line[i - 1]) segments.push(...line[i - 1], ...line[i]);
      if (line === polylines[0]) upTo.push(segments.length / 6);
    }
  }
  return { segments: new Float32Array(segments), count: segments.length / 6, upTo };
}

// Flat numbers to points; null where a coordinate is missing.
function points(flat) {
  const list = [];
  for (let i = 0; i + 2 < flat.length; i += 3) list.push(flat[i] === null ? null : [flat[i], flat[i + 1], flat[i + 2]]);
  return list;
}

// Axes t1 (horizontal) and t2 (upwards) of a palm with normal n, as in the log.
function palmAxes(n) {
  const level = Math.hypot(n[0], n[1]) || 1, up = [-n[0] * n[2] / level, -n[1] * n[2] / level, level];
  return [cross(up, n), up];
}

// The part of palm i that faces the object: its plane up to `reach` along its slope and `width` to either side, cut
// where the other palms begin.
function palmPolygon(normals, i, { reach, width }) {
  const [along, up] = palmAxes(normals[i]);
  const corner = (a, b) => add(scale(along, a * width), scale(up, b * reach));
  let polygon = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  for (let j = 0; j < 3; j++) if (j !== i) polygon = clip(polygon, normals[j]);
  return polygon;
}

function clip(polygon, n) {
  const kept = [];
  polygon.forEach((p, k) => {
    const q = polygon[(k + 1) % polygon.length], a = dot(p, n), b = dot(q, n);
    if (a >= 0) kept.push(p);
    if (a < 0 !== b < 0) kept.push(add(p, scale(sub(q, p), a / (a - b))));
  });
  return kept;
}

// A flat polygon as something to draw, with its outline.
function sheet(polygon) {
  const position = [], normal = [], triangles = [];
  const n = polygon.length > 2 ? unit(cross(sub(polygon[1], polygon[0]), sub(polygon[2], polygon[0]))) : [0, 0, 1];
  for (let k = 1; k + 1 < polygon.length; k++) {
    const face = [polygon[0], polygon[k], polygon[k + 1]];
    triangles.push({ points: face, normal: n });
    face.forEach((p) => { position.push(...p); normal.push(...n); });
  }
  return {
    triangles, vertices: polygon, position: new Float32Array(position), normal: new Float32Array(normal),
    outline: lines([[...polygon, polygon[0]]]),
  };
}

// Convex hull of points in the plane, counter-clockwise (Andrew's monotone chain).
function hull2(list) {
  const sorted = [...list].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (from) => {
    const chain = [];
    for (const p of from) {
      while (chain.length > 1 && turn(chain[chain.length - 2], chain[chain.length - 1], p) <= 0) chain.pop();
      chain.push(p);
    }
    chain.pop();
    return chain;
  };
  return [...half(sorted), ...half(sorted.reverse())];
}
