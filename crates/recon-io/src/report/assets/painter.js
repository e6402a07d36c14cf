// The same drawing calls on a plain 2-D canvas, for browsers without WebGL: far to near, no hidden lines.
class Painter {
  begin(width, height, ratio, look) {
    Object.assign(this, { width, height, ratio, look, marks: [] });
  }

  project(model, p) {
    const w = moved(model, p), m = this.look.matrix;
    const q = m[3] * w[0] + m[7] * w[1] + m[11] * w[2] + m[15];
    return [
      (0.5 + 0.5 * (m[0] * w[0] + m[4] * w[1] + m[8] * w[2] + m[12]) / q) * this.width,
      (0.5 - 0.5 * (m[1] * w[0] + m[5] * w[1] + m[9] * w[2] + m[13]) / q) * this.height,
    ];
  }

  mesh(body, model, { colour, alpha = 1, face = "both" }) {
    if (alpha < 1) {
      if (face === "back") return;
      // Bounds and palms are convex: their picture is the hull of their corners, without seams between triangles.
      const outline = hull2(body.vertices.map((p) => this.project(model, p)));
      this.marks.push((c) => { c.fillStyle = css(colour, alpha); this.path(c, outline); c.fill(); });
      return;
    }
    const light = unit(add(add(scale(this.look.back, 0.75), scale(this.look.up, 0.75)), scale(this.look.right, -0.55)));
    this.marks.push((c) => {
      c.lineWidth = 1;
      c.lineJoin = "round";
      for (const t of body.triangles) {
        const n = turned(model, t.normal);
        if (dot(n, sub(this.look.eye, moved(model, t.points[0]))) <= 0) continue;
        c.fillStyle = c.strokeStyle = css(scale(colour, 0.5 + 0.56 * (0.5 + 0.5 * dot(n, light)) ** 2), 1);
        this.path(c, t.points.map((p) => this.project(model, p)));
        c.fill();
        c.stroke(); // hides the seam to the neighbour
      }
    });
  }

  lines(set, model, { colour, alpha = 1, width = 1.5, count = set.count }) {
    this.marks.push((c) => {
      c.strokeStyle = css(colour, alpha);
      c.lineWidth = width * this.ratio;
      c.lineCap = "round";
      c.beginPath();
      for (let k = 0; k < 6 * count; k += 6) {
        c.moveTo(...this.project(model, set.segments.subarray(k, k + 3)));
        c.lineTo(...this.project(model, set.segments.subarray(k + 3, k + 6)));
      }
      c.stroke();
    });
  }

  dot(centre, model, { colour, ring, radius = 5 }) {
    const [x, y] = this.project(model, centre);
    this.marks.push((c) => {
      for (const [tone, r] of [[ring, radius], [colour, 0.68 * radius]]) {
        c.fillStyle = css(tone, 1);
        c.beginPath();
        c.arc(x, y, r * this.ratio, 0, 2 * Math.PI);
        c.fill();
      }
    });
  }

  path(c, corners) {
    c.beginPath();
    corners.forEach(([x, y], k) => (k ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.closePath();
  }

  end(context) {
    this.marks.forEach((mark) => mark(context));
  }
}

const css = (colour, alpha) => `rgba(${colour.map((v) => Math.round(255 * Math.min(1, v))).join(",")},${alpha})`;
