// Colours come from the style sheet, so that both themes are described in one place.
const theme = {
  colours: {},
  load() {
    const style = getComputedStyle(document.documentElement);
    this.colours = {};
    for (const name of ["page", "panel", "ink", "soft", "faint", "line", "p1", "p2", "p3", "q1", "q2", "q3", "bad", "truth", "body",
      "body-line", "glass", "glass-line", "floor"]) {
      const hex = style.getPropertyValue("--" + name).trim();
      this.colours[name] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
    }
  },
  get dark() { return document.documentElement.dataset.theme === "dark"; },
};

const cssColour = ([r, g, b]) => `rgb(${[r, g, b].map((v) => Math.round(255 * v)).join(",")})`;

// Arrows, axes and a length on top of a scene.
class Overlay {
  constructor(context, look, width, height, ratio) { Object.assign(this, { context, look, width, height, ratio }); }

  // Where a point of the scene is seen, px.
  place(p) {
    const m = this.look.matrix, w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
    const along = (i) => (m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]) / w;
    return [0.5 * (1 + along(0)) * this.width, 0.5 * (1 - along(1)) * this.height];
  }

  // Ends `gap` px before its end, where a dot is.
  arrow([x, y], [toX, toY], colour, width = 2, gap = 0) {
    const c = this.context, angle = Math.atan2(toY - y, toX - x), short = gap * this.ratio;
    const length = Math.hypot(toX - x, toY - y) - short, head = Math.min((5 + 1.2 * width) * this.ratio, 0.6 * length);
    if (!(length > this.ratio)) return;
    toX -= short * Math.cos(angle);
    toY -= short * Math.sin(angle);
    c.strokeStyle = c.fillStyle = cssColour(colour);
    c.lineWidth = width * this.ratio;
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(toX - 0.7 * head * Math.cos(angle), toY - 0.7 * head * Math.sin(angle));
    c.stroke();
    c.beginPath();
    c.moveTo(toX, toY);
    for (const side of [-0.45, 0.45]) c.lineTo(toX - head * Math.cos(angle + side), toY - head * Math.sin(angle + side));
    c.fill();
  }

  text(words, x, y, colour, align = "center") {
    const c = this.context;
    c.font = `${12 * this.ratio}px system-ui, sans-serif`;
    Object.assign(c, { fillStyle: cssColour(colour), textAlign: align, textBaseline: "middle" });
    c.fillText(words, x, y);
  }

  // Axes with their names in the lower left corner, and gravity beside those of the world.
  axes(names, colours, gravity) {
    const long = 30 * this.ratio, from = [46 * this.ratio, this.height - 46 * this.ratio];
    const seen = (d) => [dot(this.look.right, d), -dot(this.look.up, d)];
    const draw = (start, d, name, colour) => {
      const [x, y] = seen(d), end = [start[0] + long * x, start[1] + long * y];
      this.arrow(start, end, colour, 1.6);
      this.text(name, end[0] + 9 * this.ratio * x, end[1] + 9 * this.ratio * y, colour);
    };
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]].forEach((d, i) => draw(from, d, names[i], colours[i]));
    if (gravity) draw([from[0] + 2 * long, from[1] - 0.5 * long], [0, 0, -1], "g", gravity);
  }

  // A bar of a round length in the lower right corner, as long as it is seen at `target`.
  bar(target, colour) {
    const unit = this.place(add(target, this.look.right))[0] - this.place(target)[0];
    const most = 110 * this.ratio / unit, power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map((m) => m * power).find((l) => l <= most), c = this.context;
    const right = this.width - 18 * this.ratio, left = right - length * unit, y = this.height - 18 * this.ratio, end = 4 * this.ratio;
    c.strokeStyle = cssColour(colour);
    c.lineWidth = 1.5 * this.ratio;
    c.beginPath();
    for (const x of [left, right]) { c.moveTo(x, y - end); c.lineTo(x, y + end); }
    c.moveTo(left, y);
    c.lineTo(right, y);
    c.stroke();
    this.text(`${Number(length.toPrecision(1))} m`, 0.5 * (left + right), y - 12 * this.ratio, colour);
  }
}

// A canvas that shows a scene and can be turned. `draw(renderer, colours, look)` is called whenever it must be shown.
class Stage {
  // `over`, if there is one, draws on top, in the plane of the canvas: see `Overlay`.
  constructor(canvas, renderer, camera, draw, over) {
    Object.assign(this, { canvas, renderer, camera, draw, over, waiting: false, listeners: [] });
    this.home = { ...camera };
    this.context = canvas.getContext("2d");
    new ResizeObserver(() => this.show()).observe(canvas);
    if (canvas.classList.contains("view")) this.listen();
  }

  // Draws at the next frame; many wishes in one frame are one drawing.
  show() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => { this.waiting = false; this.paint(); });
  }

  paint() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (!width || !height) return;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const look = lookAt(this.camera, width / height);
    this.context.clearRect(0, 0, width, height);
    this.renderer.begin(width, height, ratio, look);
    this.draw(this.renderer, theme.colours, look);
    this.renderer.end(this.context);
    if (this.over) this.over(new Overlay(this.context, look, width, height, ratio));
  }

  turn(azimuth, elevation) {
    this.camera.azimuth += azimuth;
    this.camera.elevation = Math.max(-89, Math.min(89, this.camera.elevation + elevation));
    this.changed();
  }

  zoom(factor) {
    this.camera.zoom = Math.max(0.4, Math.min(6, this.camera.zoom * factor));
    this.changed();
  }

  reset() {
    Object.assign(this.camera, this.home);
    this.changed();
  }

  changed() {
    this.show();
    this.listeners.forEach((f) => f());
  }

  listen() {
    const canvas = this.canvas, held = new Map();
    let spread = 0;
    const distance = () => { const [a, b] = [...held.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    canvas.addEventListener("pointerdown", (e) => {
      held.set(e.pointerId, [e.clientX, e.clientY]);
      canvas.setPointerCapture(e.pointerId);
      if (held.size === 2) spread = distance();
    });
    canvas.addEventListener("pointermove", (e) => {
      const before = held.get(e.pointerId);
      if (!before) return;
      held.set(e.pointerId, [e.clientX, e.clientY]);
      if (held.size === 1) this.turn(-0.45 * (e.clientX - before[0]), 0.45 * (e.clientY - before[1]));
      if (held.size === 2) { const now = distance(); this.zoom(now / (spread || now)); spread = now; }
    });
    const release = (e) => held.delete(e.pointerId);
    canvas.addEventListener("pointerup", release);
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("dblclick", () => this.reset());
    // Plain scrolling belongs to the page.
    canvas.addEventListener("wheel", (e) => {
      if (!e.ctrlKey && !e.metaKey) return;
      e.preventDefault();
      this.zoom(Math.exp(-0.004 * e.deltaY));
    }, { passive: false });
    const keys = { ArrowLeft: [6, 0], ArrowRight: [-6, 0], ArrowUp: [0, 6], ArrowDown: [0, -6] };
    canvas.addEventListener("keydown", (e) => {
      if (keys[e.key]) { e.preventDefault(); this.turn(...keys[e.key]); }
      if (e.key === "+") this.zoom(1.15);
      if (e.key === "-") this.zoom(1 / 1.15);
      if (e.key === "0") this.reset();
    });
  }
}
