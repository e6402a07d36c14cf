const SVG = "http://www.w3.org/2000/svg";

function element(name, attributes = {}, parent = null) {
  const node = name.startsWith("svg:") ? document.createElementNS(SVG, name.slice(4)) : document.createElement(name);
  for (const key in attributes) {
    if (key === "text") node.textContent = attributes[key];
    else node.setAttribute(key, attributes[key]);
  }
  if (parent) parent.append(node);
  return node;
}

// The time that every figure shows; setting it moves all of them.
class Clock {
  constructor(times) { Object.assign(this, { times, index: 0, listeners: [] }); }
  get time() { return this.times[this.index]; }
  set(index) {
    const next = Math.max(0, Math.min(this.times.length - 1, index));
    if (next === this.index) return;
    this.index = next;
    this.listeners.forEach((f) => f());
  }
  nearest(t) {
    let low = 0, high = this.times.length - 1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (this.times[mid] < t) low = mid; else high = mid; }
    return t - this.times[low] < this.times[high] - t ? low : high;
  }
}

// Round numbers that divide a range into about `count` parts.
function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((m) => m * power).find((s) => s >= rough * 0.999) || 10 * power;
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(Number((k * step).toPrecision(12)));
  return list;
}

// Lines over time with a legend that reads out the values at the clock's time.
// series: { label, colour (CSS), values, truth (values or none), band (half its height about each value, or none) }; `shaded` stretches of time.
class Chart {
  constructor(parent, clock, { title, unit, series, logarithmic = false, shaded = [] }) {
    Object.assign(this, { clock, unit, series, logarithmic, shaded });
    const panel = element("div", { class: "panel chart" }, parent);
    const heading = element("h3", { text: title }, panel);
    if (unit) element("small", { text: "in " + unit }, heading);
    this.legend = element("div", { class: "legend" }, panel);
    this.readouts = series.map((s) => this.key(s));
    this.svg = element("svg:svg", { role: "img", "aria-label": title }, panel);
    this.range();
    new ResizeObserver(() => this.draw()).observe(this.svg);
    const scrub = (e) => {
      const box = this.svg.getBoundingClientRect();
      this.clock.set(this.clock.nearest(this.timeAt(e.clientX - box.left)));
    };
    this.svg.addEventListener("pointermove", scrub);
    this.svg.addEventListener("pointerdown", scrub);
    clock.listeners.push(() => this.point());
  }

  key({ label, colour }) {
    const key = element("span", { class: "key" }, this.legend);
    element("i", { class: "swatch", style: `--c:${colour}` }, key);
    element("span", { text: label }, key);
    return element("b", {}, key);
  }

  range() {
    const all = this.series.flatMap((s) => [...s.values, ...(s.truth || [])])
      .filter((v) => v !== null && (!this.logarithmic || v > 0));
    let low = Math.min(...all), high = Math.max(...all);
    if (!all.length) [low, high] = this.logarithmic ? [1e-12, 1] : [0, 1];
    if (this.logarithmic) {
      low = Math.floor(Math.log10(low)); high = Math.ceil(Math.log10(high));
      // What is left of rounding where two numbers are the same would take all of the height.
      low = Math.max(low, high - 12);
      if (high - low < 2) { low -= 1; high += 1; }
    } else {
      // Bands are shown whole as long as they leave the curves a third of the height.
      const bands = this.series.flatMap((s) => s.band || []).filter((h) => h !== null);
      const room = Math.min(bands.reduce((most, h) => Math.max(most, h), 0), high - low);
      low -= room; high += room;
      const pad = (high - low || Math.abs(high) || 1) * 0.06;
      low -= pad; high += pad;
    }
    Object.assign(this, { low, high });
  }

  level(v) { return this.logarithmic ? (v > 0 ? Math.max(Math.log10(v), this.low) : null) : v; }
  x(t) { const ts = this.clock.times; return this.left + (t - ts[0]) / (ts[ts.length - 1] - ts[0]) * this.plotWidth; }
  y(v) { return this.top + (this.high - v) / (this.high - this.low) * this.plotHeight; }
  timeAt(x) {
    const ts = this.clock.times, share = (x - this.left) / this.plotWidth;
    return ts[0] + share * (ts[ts.length - 1] - ts[0]);
  }

  draw() {
    const width = this.svg.clientWidth, height = this.svg.clientHeight;
    if (!width) return;
    Object.assign(this, { left: this.logarithmic ? 44 : 40, top: 8, plotHeight: height - 34 });
    this.plotWidth = width - this.left - 10;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.replaceChildren();
    for (const [from, to] of this.shaded) {
      const x = this.x(from), width = this.x(to) - x;
      element("svg:rect", { class: "shade", x, y: this.top, width, height: this.plotHeight }, this.svg);
    }
    this.axes();
    for (const s of this.series.filter((s) => s.band)) {
      element("svg:path", { class: "band", d: this.around(s), style: `fill:${s.colour}` }, this.svg);
    }
    for (const s of this.series) {
      // Under a dashed truth the estimate is a broad band of the same colour, so that both show where they agree.
      const look = s.truth ? "curve under" : this.logarithmic ? "curve fine" : "curve";
      element("svg:path", { class: look, d: this.path(s.values), style: `stroke:${s.colour}` }, this.svg);
    }
    for (const s of this.series.filter((s) => s.truth)) {
      element("svg:path", { class: "curve true", d: this.path(s.truth), style: `stroke:${s.colour}` }, this.svg);
    }
    this.cursor = element("svg:line", { class: "cursor", y1: this.top, y2: this.top + this.plotHeight }, this.svg);
    this.dots = this.series.map((s) => element("svg:circle", { r: 3.5, style: `fill:${s.colour}` }, this.svg));
    this.point();
  }

  axes() {
    const bottom = this.top + this.plotHeight, ts = this.clock.times;
    const text = (x, y, words, anchor) => element("svg:text", { x, y, "text-anchor": anchor, text: words }, this.svg);
    const step = this.logarithmic ? Math.max(1, Math.ceil((this.high - this.low) / 5)) : 0;
    const marks = this.logarithmic
      ? Array.from({ length: Math.floor((this.high - this.low) / step) + 1 }, (_, k) => this.low + k * step)
      : ticks(this.low, this.high, 6);
    for (const v of marks) {
      element("svg:line", { class: "grid", x1: this.left, x2: this.left + this.plotWidth, y1: this.y(v), y2: this.y(v) }, this.svg);
      text(this.left - 7, this.y(v) + 4, this.logarithmic ? format(10 ** v, 1).replace("1 × ", "") : plain(v, marks), "end");
    }
    const times = ticks(ts[0], ts[ts.length - 1], Math.max(3, Math.min(8, this.plotWidth / 75)));
    for (const t of times) {
      element("svg:line", { class: "grid", x1: this.x(t), x2: this.x(t), y1: bottom, y2: bottom + 4 }, this.svg);
      if (this.x(t) < this.left + this.plotWidth - 45) text(this.x(t), bottom + 17, plain(t, times), "middle");
    }
    text(this.left + this.plotWidth, bottom + 17, "t in s", "end");
  }

  path(values) {
    let d = "", pen = false;
    values.forEach((value, k) => {
      const v = value === null ? null : this.level(value);
      if (v === null) { pen = false; return; }
      d += (pen ? "L" : "M") + this.x(this.clock.times[k]).toFixed(1) + " " + this.y(v).toFixed(1);
      pen = true;
    });
    return d;
  }

  // The outline of the band about a curve, in pieces where the curve is broken.
  around({ values, band }) {
    const inside = (v) => Math.max(this.top, Math.min(this.top + this.plotHeight, this.y(v))).toFixed(1);
    let d = "", piece = [];
    const close = () => {
      const edge = (side) => piece.map((k) => this.x(this.clock.times[k]).toFixed(1) + " " + inside(values[k] + side * band[k]));
      if (piece.length > 1) d += "M" + edge(1).join("L") + "L" + edge(-1).reverse().join("L") + "Z";
      piece = [];
    };
    values.forEach((v, k) => { if (v === null || band[k] === null) close(); else piece.push(k); });
    close();
    return d;
  }

  // Moves the cursor and the read-outs to the clock's time.
  point() {
    const k = this.clock.index, x = this.x(this.clock.time);
    this.series.forEach((s, i) => { this.readouts[i].textContent = format(s.values[k], this.logarithmic ? 2 : 4); });
    if (!this.cursor) return;
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.series.forEach((s, i) => {
      const v = s.values[k] === null ? null : this.level(s.values[k]);
      this.dots[i].setAttribute("visibility", v === null ? "hidden" : "visible");
      if (v !== null) { this.dots[i].setAttribute("cx", x); this.dots[i].setAttribute("cy", this.y(v)); }
    });
  }
}

// Tick labels of one axis with equally many decimals.
function plain(v, marks) {
  const decimals = Math.max(0, ...marks.map((m) => (String(m).split(".")[1] || "").length));
  const text = Math.abs(v) >= 1e5 || decimals > 5 ? format(v, 3) : v.toFixed(decimals);
  return text.replace("-", "−");
}
