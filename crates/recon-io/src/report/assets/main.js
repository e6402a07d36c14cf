const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
// Settings in the address, such as #theme=dark&t=2.1&turn=40,-10&painter: for links and for pictures.
const wish = new URLSearchParams(location.hash.slice(1));

const preferred = matchMedia("(prefers-color-scheme: dark)");
let chosen = wish.get("theme");
function dress() {
  document.documentElement.dataset.theme = chosen || (preferred.matches ? "dark" : "light");
  byId("theme").textContent = theme.dark ? "Light" : "Dark";
  theme.load();
}
dress();

const scene = prepare(data), clock = new Clock(data.t);
const renderer = (!wish.has("painter") && WebGl.make()) || new Painter();
const stages = [];

preferred.addEventListener("change", () => { dress(); stages.forEach((s) => s.show()); });
byId("theme").addEventListener("click", () => {
  chosen = theme.dark ? "light" : "dark";
  dress();
  stages.forEach((s) => s.show());
});

function stage(canvas, camera, draw, over) {
  const made = new Stage(canvas, renderer, camera, draw, over);
  stages.push(made);
  return made;
}

function motionFigure() {
  const { extents, camera } = motionCamera(data, scene);
  const show = { palms: true, trails: true, forces: true, shape: true, upper: true };
  const draw = (look) => (r, c, l) => drawMotion(r, c, l, data, scene, look.k(), extents, look.show);
  const over = (o) => {
    const k = clock.index, c = theme.colours;
    if (show.forces) forceArrows(data, scene, k).forEach(([from, to, i]) => o.arrow(o.place(from), o.place(to), c[PALMS[i]], 2.4, 7));
    o.context.fillStyle = cssColour(c.ink);
    const [x, y] = o.place(scene.p[k]);
    o.context.beginPath();
    o.context.arc(x, y, 3.5 * o.ratio, 0, 7);
    o.context.fill();
    o.axes(["x", "y", "z"], [c.q1, c.q2, c.q3], c.bad);
    o.bar(camera.target, c.soft);
  };
  const main = stage(byId("motion-view"), camera, draw({ k: () => clock.index, show }), over);
  const legend = byId("motion-toggles");
  PALMS.forEach((name, i) => {
    const key = element("span", { class: "key" }, legend);
    element("i", { class: "swatch", style: `--c:var(--${name})` }, key);
    element("span", { text: "palm " + (i + 1) }, key);
  });
  const layers = [["palms", "palms"], ["trails", "contacts on the palms"]];
  if (data.palms.some((palm) => palm.force.some((f) => f > 0))) layers.push(["forces", "contact forces"]);
  if (scene.body.shape) layers.push(["shape", "true shape instead of bounds"]);
  else if (scene.body.upper) layers.push(["upper", "upper bound"]);
  toggles(legend, main, show, layers);
  const small = snapshots(camera, draw, show);
  main.listeners.push(() => small.forEach((s) => { Object.assign(s.camera, camera); s.show(); }));
  clock.listeners.push(() => main.show());
  const first = data.t[0], last = data.t[data.t.length - 1];
  const still = scene.normals.every((n) => n.length === 1);
  byId("motion-caption").textContent =
    `The object on its three ${still ? "immobile" : "moving"} palms from ${format(first, 3)} s to ${format(last, 3)} s, as estimated. ` +
    "Each colour is one palm: its surface, the path of the contact on it, the path of the contact on the object, and its force. " +
    "The dot in the middle of it is the centre of mass, g gravity; the length is that at the middle of the picture. " +
    "Drag to turn, Ctrl and wheel to zoom; a small picture jumps to its time.";
  return main;
}

// Eight pictures evenly spread over the log, like the paper's Fig. 5.
function snapshots(camera, draw, show) {
  const parent = byId("snapshots"), first = data.t[0], last = data.t[data.t.length - 1];
  return Array.from({ length: 8 }, (_, i) => {
    const k = clock.nearest(first + i * (last - first) / 7);
    const button = element("button", { class: "snapshot", type: "button" }, parent);
    const canvas = element("canvas", {}, button);
    element("span", { text: `t = ${Number(data.t[k].toFixed(2))} s` }, button);
    button.addEventListener("click", () => { player.stop(); clock.set(k); });
    const mark = () => button.classList.toggle("now", clock.index === k);
    clock.listeners.push(mark);
    mark();
    const own = Object.create(show, { small: { value: true } });
    return stage(canvas, { ...camera }, draw({ k: () => k, show: own }));
  });
}

// Plays the log in real time, or slower where it is short and faster where it is long.
const player = {
  running: false,
  icon(running) {
    byId("play").innerHTML = running
      ? '<svg viewBox="0 0 14 14"><path d="M2 1h3.5v12H2zM8.5 1H12v12H8.5z"/></svg>'
      : '<svg viewBox="0 0 14 14"><path d="M3 1l10 6-10 6z"/></svg>';
    byId("play").setAttribute("aria-label", running ? "Pause" : "Play");
  },
  start() {
    const last = data.t[data.t.length - 1], span = last - data.t[0];
    const pace = span / Math.max(4, Math.min(20, span));
    if (clock.index === data.t.length - 1) clock.set(0);
    this.running = true;
    this.icon(true);
    let shown = clock.time, before = performance.now();
    const step = (now) => {
      if (!this.running) return;
      shown += pace * (now - before) / 1000;
      before = now;
      clock.set(clock.nearest(shown));
      if (shown >= last) this.stop(); else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  },
  stop() { this.running = false; this.icon(false); },
};

function timeBar() {
  const slider = byId("time"), show = () => {
    slider.value = clock.index;
    byId("clock").textContent = `t = ${clock.time.toFixed(2)} s`;
  };
  slider.max = data.t.length - 1;
  slider.addEventListener("input", () => { player.stop(); clock.set(Number(slider.value)); });
  byId("play").addEventListener("click", () => (player.running ? player.stop() : player.start()));
  clock.listeners.push(show);
  player.icon(false);
  show();
}

function charts() {
  const parent = byId("charts"), { motion, truth, departure, band, doubtful: shaded } = data;
  const part = (list, size, i) => list.filter((_, k) => k % size === i);
  const split = (key, size, labels, colours) => labels.map((label, i) => ({
    label, colour: `var(--${colours[i]})`, values: part(motion[key], size, i), truth: truth && part(truth[key], size, i), band: part(band[key], size, i),
  }));
  new Chart(parent, clock, {
    title: "Radius functions", unit: "m", shaded,
    series: data.palms.map((palm, i) => ({
      label: `r${"₁₂₃"[i]} (palm ${i + 1})`, colour: `var(--p${i + 1})`, values: palm.radius, truth: palm.trueRadius, band: palm.radiusBand,
    })),
  });
  new Chart(parent, clock, {
    title: "Centre of mass, world", unit: "m", shaded, series: split("p", 3, ["x", "y", "z"], ["q1", "q2", "q3"]),
  });
  new Chart(parent, clock, {
    title: "Orientation, body to world (unit quaternion)", shaded, series: split("q", 4, ["w", "x", "y", "z"], ["q0", "q1", "q2", "q3"]),
  });
  new Chart(parent, clock, {
    title: "Angular velocity, world axes", unit: "rad/s", shaded, series: split("w", 3, ["ωx", "ωy", "ωz"], ["q1", "q2", "q3"]),
  });
  if (data.palms.some((palm) => palm.force.some((f) => f !== null))) new Chart(parent, clock, {
    title: "Contact forces", unit: "N", shaded,
    series: data.palms.map((palm, i) => ({ label: `palm ${i + 1}`, colour: `var(--p${i + 1})`, values: palm.force })),
  });
  if (departure) new Chart(parent, clock, {
    title: "Distance from the truth", logarithmic: true, series: [
      { label: "position, m", colour: "var(--q0)", values: departure.p },
      { label: "orientation, rad", colour: "var(--q1)", values: departure.angle },
      { label: "angular velocity, rad/s", colour: "var(--q3)", values: departure.w },
    ],
  });
  byId("curves-caption").textContent =
    "The radius functions r₁, r₂, r₃ are the distances of the palms' planes from the centre of mass. " +
    "Bands hold 95 % of what the estimate may be off by (two deviations). " + (shaded.length ? "Shaded: not relied on. " : "") +
    (truth ? "Estimates are broad lines, the truth is dashed. " : "") +
    "Move over a chart to read the values; all figures follow.";
}

function boundsFigure() {
  if (!data.bounds) { byId("bounds-section").remove(); return null; }
  const show = { lower: true, upper: true, curves: true, truth: true, next: true };
  const camera = boundsCamera(data, scene), spot = data.bounds.apart;
  const over = (o) => {
    const c = theme.colours;
    if (spot && show.next) {
      const from = o.place(scale(spot, 1 + 0.35 * data.size / norm(spot)));
      o.arrow(from, o.place(spot), c.bad, 2.4);
      o.text("touch next", from[0], from[1] - 10 * o.ratio, c.bad);
    }
    o.axes(["x", "y", "z"], [c.q1, c.q2, c.q3], null);
    o.bar(camera.target, c.soft);
  };
  const made = stage(byId("bounds-view"), camera, (r, c) => drawBounds(r, c, scene, show, clock.index), over);
  const layers = [["lower", "lower bound", { colour: "body", kind: "fill" }]];
  if (scene.body.upper) layers.push(["upper", "upper bound", { colour: "glass", kind: "fill" }]);
  layers.push(["curves", "contact curves", { colour: "p1", kind: "three" }]);
  if (scene.body.wire) layers.push(["truth", "true shape", { colour: "truth", kind: "thin" }]);
  if (spot) layers.push(["next", "where to touch next", { colour: "bad", kind: "thin" }]);
  toggles(byId("bounds-toggles"), made, show, layers);
  clock.listeners.push(() => made.show());
  const { lower, upper } = data.bounds, rows = [["Lower bound", lower.volume, "body"]];
  if (data.shape && data.shape.volume) rows.push(["True shape", data.shape.volume, "truth"]);
  if (upper) rows.push(["Upper bound", upper.volume, "glass"]);
  volumes(rows, lower, upper);
  byId("bounds-caption").textContent =
    "The object seen from its own axes. Every convex object with these contacts contains the lower bound, the hull of the contact curves" +
    (upper ? ", and is contained in the upper bound, the room that the palms' planes left to it" + (spot ? "; the arrow shows where the two are farthest apart." : ".") : "; the palms' planes leave it unbounded on some side, so there is no upper bound.");
  return made;
}

function volumes(rows, lower, upper) {
  const table = element("table", {}, byId("volumes"));
  const top = element("tr", {}, element("thead", {}, table));
  ["Volume", "m³"].forEach((text, i) => element("th", { text, style: i ? "text-align:right" : "" }, top));
  const body = element("tbody", {}, table), row = (name, text) => {
    const line = element("tr", {}, body);
    const cell = element("td", { text: name }, line);
    element("td", { class: "number", text }, line);
    return cell;
  };
  const largest = Math.max(...rows.map((r) => r[1]));
  rows.forEach(([name, volume, colour]) => {
    const cell = row(name, brief(volume)), bar = element("i", { class: "bar-volume" }, cell);
    bar.style.cssText = `--c:var(--${colour});width:${(100 * volume / largest).toFixed(1)}%`;
  });
  if (!upper) row("Upper bound", "unbounded");
  if (upper) row("Lower / upper", format(lower.volume / upper.volume, 4));
  if (data.shape && data.shape.volume) {
    row("Lower / true", format(lower.volume / data.shape.volume, 4));
    if (upper) row("Upper / true", format(upper.volume / data.shape.volume, 4));
  }
}

const motionStage = motionFigure();
timeBar();
charts();
const boundsStage = boundsFigure();
byId("footer").textContent = `Written by recon ${data.version}. SI units; world Z is up; quaternions w first. The numbers are in the files beside this page.`;

if (wish.has("t")) clock.set(clock.nearest(Number(wish.get("t"))));
if (wish.has("turn")) {
  const [azimuth, elevation] = wish.get("turn").split(",").map(Number);
  for (const s of [motionStage, boundsStage]) if (s) s.turn(azimuth || 0, elevation || 0);
}
