const PALMS = ["p1", "p2", "p3"];

// What is drawn, prepared once from the page's data.
function prepare(data) {
  const body = {
    lower: data.bounds && data.bounds.lower.f.length ? solid(data.bounds.lower) : null,
    upper: data.bounds && data.bounds.upper && data.bounds.upper.f.length ? solid(data.bounds.upper) : null,
    shape: data.shape && data.shape.mesh.f.length ? smooth(solid(data.shape.mesh)) : null,
    wire: data.shape && data.shape.lines.length ? lines(data.shape.lines.map(points)) : null,
  };
  const normals = data.palms.map((palm) => points(palm.normals));
  const curves = data.palms.map((palm, i) => {
    const world = points(palm.world), own = points(palm.body);
    // The path on the palm is drawn in the palm's own axes, and so moves with it.
    const onPalm = world.map((c, k) => {
      const [t1, t2] = palmAxes(normals[i][Math.min(k, normals[i].length - 1)]);
      return c && [dot(c, t1), dot(c, t2), 0];
    });
    return { world, own, onPalm, palmLine: lines([onPalm]), ownLine: lines([own]) };
  });
  const p = points(data.motion.p), q = [];
  for (let i = 0; i < data.motion.q.length; i += 4) q.push(data.motion.q.slice(i, i + 4));
  return { body, curves, p, q, normals };
}

// The three palm normals at time k; an immobile palm has one for all times.
const normalsAt = (scene, k) => scene.normals.map((n) => n[Math.min(k, n.length - 1)]);

// How far up the palms the contacts go, and a view that holds the palms and the object at all times.
function motionCamera(data, scene) {
  const normals = normalsAt(scene, 0), extents = { reach: 0, width: 0 };
  for (const curve of scene.curves) for (const s of curve.onPalm) if (s) {
    extents.reach = Math.max(extents.reach, norm(s));
    extents.width = Math.max(extents.width, Math.abs(s[0]));
  }
  extents.reach += 0.4 * data.size;
  extents.width += 0.4 * data.size;
  // Over the first palm, seen from outside and drawn faintly: the other two then stand left and right of the object.
  const azimuth = Math.atan2(-normals[0][1], -normals[0][0]) * 180 / Math.PI + 12;
  const extent = [];
  for (let part = 0; part < 12; part++) {
    const now = normalsAt(scene, Math.floor(part / 11 * (scene.p.length - 1)));
    now.forEach((_, i) => extent.push(...palmPolygon(now, i, extents)));
  }
  for (const p of scene.p) for (const d of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
    extent.push(add(p, scale(d, 0.85 * data.size)), sub(p, scale(d, 0.85 * data.size)));
  }
  const camera = { azimuth, elevation: 33, zoom: 1, target: scale(scene.p[0], 0.5), reach: extents.reach };
  return { extents, camera: fit(camera, extent) };
}

// Draws the object on its palms at time k (the paper's Fig. 5).
function drawMotion(renderer, c, look, data, scene, k, extents, show) {
  const normals = normalsAt(scene, k), m = pose(scene.q[k], scene.p[k]);
  const sheets = scene.sheets && scene.sheetsAt === stillKey(scene, k) ? scene.sheets
    : normals.map((_, i) => sheet(palmPolygon(normals, i, extents)));
  Object.assign(scene, { sheets, sheetsAt: stillKey(scene, k) });
  const palms = (near) => normals.forEach((n, i) => {
    // A palm through the origin shows its inner side when the eye is on that side; then it is behind the object.
    if ((dot(n, look.eye) < 0) !== near || !show.palms) return;
    const colour = c[PALMS[i]];
    renderer.mesh(sheets[i], IDENTITY, { colour, alpha: near ? 0.06 : theme.dark ? 0.2 : 0.15 });
    renderer.lines(sheets[i].outline, IDENTITY, { colour, alpha: near ? 0.35 : 0.6, width: 1 });
  });
  palms(false);
  if (show.trails) scene.curves.forEach((curve, i) => {
    const [t1, t2] = palmAxes(normals[i]), palm = [...t1, 0, ...t2, 0, ...normals[i], 0, 0, 0, 0, 1];
    renderer.lines(curve.palmLine, palm, { colour: c[PALMS[i]], alpha: 0.28, width: 1.5 });
    renderer.lines(curve.palmLine, palm, { colour: c[PALMS[i]], width: 2, count: curve.palmLine.upTo[k] });
  });
  drawBody(renderer, c, scene, m, show);
  scene.curves.forEach((curve, i) => {
    renderer.lines(curve.ownLine, m, { colour: c[PALMS[i]], width: show.small ? 1.6 : 2.5, count: curve.ownLine.upTo[k] });
    if (curve.world[k]) renderer.dot(curve.world[k], IDENTITY, { colour: c[PALMS[i]], ring: c.panel, radius: show.small ? 3.5 : 6 });
  });
  palms(true);
}

// Where the arrow of each palm's force begins and ends, and which palm: the longest of the log is as long as the object is large.
function forceArrows(data, scene, k) {
  const largest = Math.max(...data.palms.flatMap((palm) => palm.force.filter((f) => f !== null)));
  return normalsAt(scene, k).map((n, i) => {
    const to = scene.curves[i].world[k], force = data.palms[i].force[k];
    return to && force > 0 ? [sub(to, scale(n, 0.8 * data.size * force / largest)), to, i] : null;
  }).filter(Boolean);
}

const stillKey = (scene, k) => scene.normals.map((n) => Math.min(k, n.length - 1)).join();

function drawBody(renderer, c, scene, m, show) {
  const { shape, lower, upper, wire } = scene.body;
  const whole = show.shape && shape;
  if (whole) {
    renderer.mesh(shape, m, { colour: c.body, face: "front" });
    if (wire) renderer.lines(wire, m, { colour: c["body-line"], alpha: 0.5, width: show.small ? 0.6 : 1 });
    return;
  }
  if (show.upper && upper) renderer.mesh(upper, m, { colour: c.glass, alpha: 0.25, glass: 1, face: "back" });
  if (lower) {
    renderer.mesh(lower, m, { colour: c.body, face: "front" });
    renderer.lines(lower.creases, m, { colour: c["body-line"], alpha: 0.35, width: 0.8 });
  }
  if (show.upper && upper) renderer.mesh(upper, m, { colour: c.glass, alpha: 0.25, glass: 1, face: "front" });
}

// Draws the bounds around the contact curves in the object's own frame (the paper's Fig. 7).
function drawBounds(renderer, c, scene, show, k) {
  const { lower, upper, wire } = scene.body, still = IDENTITY;
  if (show.upper && upper) {
    renderer.mesh(upper, still, { colour: c.glass, alpha: 0.3, glass: 1, face: "back" });
    renderer.lines(upper.creases, still, { colour: c["glass-line"], alpha: 0.22, width: 0.8 });
  }
  if (show.truth && wire && !(show.lower && lower)) renderer.lines(wire, still, { colour: c.truth, alpha: 0.4, width: 1 });
  if (show.lower && lower) {
    renderer.mesh(lower, still, { colour: c.body, face: "front" });
    renderer.lines(lower.creases, still, { colour: c["body-line"], alpha: 0.3, width: 0.8 });
    if (show.truth && wire) renderer.lines(wire, still, { colour: c.truth, alpha: 0.42, width: 1 });
  }
  if (show.curves) scene.curves.forEach((curve, i) => {
    renderer.lines(curve.ownLine, still, { colour: c[PALMS[i]], width: 3 });
    if (curve.own[k]) renderer.dot(curve.own[k], still, { colour: c[PALMS[i]], ring: c.panel, radius: 6 });
  });
  if (show.upper && upper) {
    renderer.mesh(upper, still, { colour: c.glass, alpha: 0.22, glass: 1, face: "front" });
    renderer.lines(upper.creases, still, { colour: c["glass-line"], alpha: 0.5, width: 0.8 });
  }
}

// Seen from the side on which most contacts are.
function boundsCamera(data, scene) {
  const own = scene.curves.flatMap((curve) => curve.own.filter(Boolean));
  const side = unit(own.reduce((sum, p) => add(sum, unit(p)), [0, 0, 0]));
  const vertices = [scene.body.lower, scene.body.upper, scene.body.shape].filter(Boolean).flatMap((b) => b.vertices);
  // An upper bound that runs far off would leave the rest tiny.
  const extent = [...own, ...vertices].map((p) => scale(p, Math.min(1, 2.5 * data.size / norm(p) || 1)));
  const azimuth = Math.atan2(side[1], side[0]) * 180 / Math.PI + 25;
  const elevation = Math.max(-35, Math.min(35, Math.asin(side[2]) * 180 / Math.PI)) + 12;
  const camera = fit({ azimuth, elevation, zoom: 1, target: [0, 0, 0], reach: data.size }, extent);
  // Some room for the body as it turns.
  const radius = 0.82 * Math.max(...extent.map((p) => norm(sub(p, camera.target))));
  for (const key of ["reach", "reachAcross"]) camera[key] = Math.max(camera[key], radius);
  return camera;
}

// A row of switches over the layers of a figure; `show` holds their state.
function toggles(parent, stage, show, entries) {
  for (const [key, label, look] of entries) {
    const box = element("label", {}, parent);
    const input = element("input", { type: "checkbox" }, box);
    input.checked = show[key];
    if (look) element("i", { class: "swatch " + (look.kind || ""), style: `--c:var(--${look.colour})` }, box);
    element("span", { text: label }, box);
    input.addEventListener("change", () => { show[key] = input.checked; stage.changed(); });
  }
  const reset = element("button", { class: "reset", type: "button", text: "Reset view" }, parent);
  reset.addEventListener("click", () => stage.reset());
}
