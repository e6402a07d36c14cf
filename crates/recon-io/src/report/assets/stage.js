// Colours come from the style sheet, so that both themes are described in one place.
const theme = {
  colours: {},
  load() {
    const style = getComputedStyle(document.documentElement);
    this.colours = {};
    for (const name of ["page", "panel", "ink", "soft", "faint", "line", "p1", "p2", "p3", "truth", "body", "body-line",
      "glass", "glass-line", "floor"]) {
      const hex = style.getPropertyValue("--" + name).trim();
      this.colours[name] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);
    }
  },
  get dark() { return document.documentElement.dataset.theme === "dark"; },
};

// A canvas that shows a scene and can be turned. `draw(renderer, colours, look)` is called whenever it must be shown.
class Stage {
  constructor(canvas, renderer, camera, draw) {
    Object.assign(this, { canvas, renderer, camera, draw, waiting: false, listeners: [] });
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
