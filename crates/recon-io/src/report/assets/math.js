// Vectors are arrays of 3, matrices column-major arrays of 16, quaternions [w, x, y, z].
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => { const l = norm(a); return l > 0 ? scale(a, 1 / l) : [0, 0, 0]; };

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

function multiply(a, b) {
  const m = new Array(16);
  for (let c = 0; c < 4; c++) {
    for (let r = 0; r < 4; r++) {
      m[4 * c + r] = a[r] * b[4 * c] + a[4 + r] * b[4 * c + 1] + a[8 + r] * b[4 * c + 2] + a[12 + r] * b[4 * c + 3];
    }
  }
  return m;
}

// Pose of a body: rotation by a quaternion, then a shift.
function pose(q, p) {
  const [w, x, y, z] = q;
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0,
    2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0,
    2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0,
    p[0], p[1], p[2], 1,
  ];
}

const moved = (m, p) => [
  m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12],
  m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13],
  m[2] * p[0] + m[6] * p[1] + m[10] * p[2] + m[14],
];
const turned = (m, p) => [
  m[0] * p[0] + m[4] * p[1] + m[8] * p[2],
  m[1] * p[0] + m[5] * p[1] + m[9] * p[2],
  m[2] * p[0] + m[6] * p[1] + m[10] * p[2],
];

// A camera on a sphere about `target`; angles in degrees. A ball of radius `reach` fills the height of the picture at
// zoom 1, one of radius `reachAcross` its width, whichever needs more distance.
const FIELD_OF_VIEW = 26 * Math.PI / 180;
function lookAt(camera, aspect) {
  const az = camera.azimuth * Math.PI / 180, el = camera.elevation * Math.PI / 180;
  const back = [Math.cos(el) * Math.cos(az), Math.cos(el) * Math.sin(az), Math.sin(el)];
  const right = [-Math.sin(az), Math.cos(az), 0];
  const up = cross(back, right);
  const reach = Math.max(camera.reach, (camera.reachAcross || camera.reach) / aspect);
  const distance = reach / Math.sin(FIELD_OF_VIEW / 2) / camera.zoom;
  const eye = add(camera.target, scale(back, distance));
  const view = [
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1,
  ];
  const near = distance * 0.05, far = distance + 8 * reach, f = 1 / Math.tan(FIELD_OF_VIEW / 2);
  const projection = [
    f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0,
  ];
  return { eye, right, up, back, matrix: multiply(projection, view) };
}

// Moves `camera` and sets its reaches so that the points fill a picture of any shape with a small margin.
function fit(camera, list) {
  for (let pass = 0; pass < 4; pass++) {
    const { eye, right, up, back, matrix: m } = lookAt(camera, 1);
    let box = [Infinity, -Infinity, Infinity, -Infinity];
    for (const p of list) {
      const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
      const x = (m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12]) / w;
      const y = (m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13]) / w;
      box = [Math.min(box[0], x), Math.max(box[1], x), Math.min(box[2], y), Math.max(box[3], y)];
    }
    const half = Math.tan(FIELD_OF_VIEW / 2) * dot(sub(eye, camera.target), back);
    const shift = add(scale(right, 0.5 * (box[0] + box[1]) * half), scale(up, 0.5 * (box[2] + box[3]) * half));
    const unit = half * Math.cos(FIELD_OF_VIEW / 2) / 2 / 0.9;
    Object.assign(camera, {
      target: add(camera.target, shift), reachAcross: (box[1] - box[0]) * unit, reach: (box[3] - box[2]) * unit,
    });
  }
  return camera;
}

// A number as on the console and in the key figures: six digits.
const brief = (x) => String(Number(x.toPrecision(6)));

// Numbers as people read them: four digits, a true minus, powers of ten as superscripts.
function format(x, digits = 4) {
  if (x === null || x === undefined || !isFinite(x)) return "–";
  const size = Math.abs(x);
  let text;
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) {
    const [mantissa, exponent] = x.toExponential(Math.max(0, Math.min(digits, 3) - 1)).split("e");
    text = mantissa + " × 10" + [...String(Number(exponent))].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] || "⁻").join("");
  } else {
    text = Number.isInteger(x) ? String(x) : x.toPrecision(digits);
  }
  return text.replace("-", "−");
}
