// SPDX-License-Identifier: Apache-2.0
// The page of `earthshine view FILE.h5`: patches in false colours, turned about the middle of the scene. Faces show
// their fronts alone, so that a room is seen through its nearer walls.
const solidVertex = `#version 300 es
in vec3 place;
in vec4 colour;
in vec2 inside;
uniform mat3 turn;
uniform vec3 middle, eye;
uniform vec2 zoom;
out vec4 tint;
out vec2 at;
void main() {
  vec3 p = turn * (place - middle) - eye;
  tint = colour;
  at = inside;
  float near = 0.01 * eye.z, far = 100.0 * eye.z;
  gl_Position = vec4(zoom * p.xy, (-p.z * (far + near) - 2.0 * far * near) / (far - near), -p.z);
}`;
const solidFragment = `#version 300 es
precision highp float;
in vec4 tint;
in vec2 at;
uniform float cells;
out vec4 shown;
void main() {
  vec2 border = min(at, 1.0 - at) / fwidth(at);
  float line = cells * (1.0 - smoothstep(0.5, 1.5, min(border.x, border.y)));
  shown = vec4(mix(tint.rgb, vec3(1.0), 0.6 * line), 1.0);
}`;

const floats = async (id) => new Float32Array((await unpackBytes(id)).buffer);
const solid = { corners: null, object: null, values: null, top: 0, layer: null, middle: [0, 0, 0], radius: 1 };
const view = { azimuth: 0.6, height: 0.5, distance: 2.5, across: 0, down: 0 };
const angle = 0.35; // tangent of half the vertical field of view

// Rows of the rotation from the scene to the eye's axes: x right, y up, z toward the eye; the scene's z is up.
const turnOf = ({ azimuth, height }) => {
  const [ca, sa, ch, sh] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(height), Math.sin(height)];
  return [[-sa, ca, 0], [-sh * ca, -sh * sa, ch], [ch * ca, ch * sa, sh]];
};
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const eyeOf = () => [view.across * solid.radius, view.down * solid.radius, view.distance * solid.radius];

const makeSolid = () => {
  const canvas = byId("picture"), gl = canvas.getContext("webgl2", { preserveDrawingBuffer: true });
  if (!gl) throw new Error("this browser has no WebGL2");
  const program = makeProgram(gl, solidVertex, solidFragment);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const fill = (name, values, size, kind, isShare) => {
    const at = gl.getAttribLocation(program, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, kind, isShare, 0, 0);
  };
  const count = solid.object.length, order = [0, 1, 2, 0, 2, 3];
  const places = new Float32Array(18 * count), inside = new Float32Array(12 * count);
  for (let p = 0; p < count; ++p) {
    order.forEach((corner, k) => {
      for (let c = 0; c < 3; ++c) places[18 * p + 3 * k + c] = solid.corners[12 * p + 3 * corner + c];
      inside[12 * p + 2 * k] = corner === 1 || corner === 2 ? 1 : 0;
      inside[12 * p + 2 * k + 1] = corner >= 2 ? 1 : 0;
    });
  }
  fill("place", places, 3, gl.FLOAT, false);
  fill("inside", inside, 2, gl.FLOAT, false);
  const colours = new Uint8Array(24 * count);
  const paint = () => {
    for (let p = 0; p < count; ++p) {
      const from = 4 * falseIndex(solid.values[p], solid.top + Number(byId("white").value));
      for (let k = 0; k < 24; ++k) colours[24 * p + k] = falseTable[from + (k & 3)];
    }
    fill("colour", colours, 4, gl.UNSIGNED_BYTE, true);
  };
  const place = (name) => gl.getUniformLocation(program, name);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.CULL_FACE);
  gl.clearColor(0.07, 0.08, 0.1, 1);
  const draw = () => {
    const box = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(box.width * ratio));
    canvas.height = Math.max(1, Math.round(box.height * ratio));
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const rows = turnOf(view);
    gl.uniformMatrix3fv(place("turn"), false, [0, 1, 2].flatMap((column) => rows.map((row) => row[column])));
    gl.uniform3fv(place("middle"), solid.middle);
    gl.uniform3fv(place("eye"), eyeOf());
    gl.uniform2f(place("zoom"), canvas.height / canvas.width / angle, 1 / angle);
    gl.uniform1f(place("cells"), byId("cells").checked ? 1 : 0);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * count);
  };
  return { paint, draw };
};

// The patch at a place of the canvas, -1 to 1 across and up: Moeller and Trumbore's test of both triangles of each.
const patchAt = (x, y, ratio) => {
  const rows = turnOf(view), eye = eyeOf();
  const world = (v) => [0, 1, 2].map((c) => rows[0][c] * v[0] + rows[1][c] * v[1] + rows[2][c] * v[2]);
  const origin = world(eye).map((value, c) => value + solid.middle[c]);
  const way = world([x * angle * ratio, y * angle, -1]);
  let nearest = Infinity, found = -1;
  const corner = (p, k) => [0, 1, 2].map((c) => solid.corners[12 * p + 3 * k + c]);
  for (let p = 0; p < solid.object.length; ++p) {
    const a = corner(p, 0);
    for (const [k, l] of [[1, 2], [2, 3]]) {
      const u = minus(corner(p, k), a), v = minus(corner(p, l), a), normal = cross(u, v);
      const fall = -dot(way, normal);
      if (!(fall > 0)) continue; // the back
      const off = minus(origin, a), t = dot(off, normal) / fall;
      if (!(t > 0) || t >= nearest) continue;
      const side = cross(off, way), s = dot(v, side) / fall, r = -dot(u, side) / fall;
      if (s < 0 || r < 0 || s + r > 1) continue;
      nearest = t;
      found = p;
    }
  }
  return found;
};

const reading = (x, y) => {
  const box = byId("picture").getBoundingClientRect();
  const p = patchAt((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height, box.width / box.height);
  byId("value").textContent = p < 0 ? "" : `${solid.values[p].toPrecision(4)} ${solid.layer.unit}`;
  byId("place").textContent = p < 0 ? "" : `${data.objects[solid.object[p]]}, patch ${p}`;
};

const start = async () => {
  solid.corners = await floats(data.corners);
  solid.object = new Uint32Array((await unpackBytes(data.object)).buffer);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < solid.corners.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], solid.corners[i]);
    high[i % 3] = Math.max(high[i % 3], solid.corners[i]);
  }
  if (solid.corners.length > 0) solid.middle = low.map((value, c) => 0.5 * (value + high[c]));
  solid.radius = Math.max(1e-6, 0.5 * Math.hypot(...low.map((value, c) => high[c] - value)) || 1);
  if (data.layers.length === 0) throw new Error("the solution has no light");
  const { paint, draw } = makeSolid();
  const scale = () => {
    const top = solid.top + Number(byId("white").value);
    byId("stops").value = `${(10 ** top).toPrecision(3)} ${solid.layer.unit}`;
    showScale(top, solid.layer.unit);
    paint();
    draw();
  };
  const choose = async () => {
    solid.layer = data.layers[byId("layer").selectedIndex];
    solid.values = await floats(solid.layer.data);
    solid.top = falseTopOf(solid.values);
    scale();
    document.body.dataset.ready = solid.layer.name;
  };
  const turn = (across, up) => {
    view.azimuth -= across;
    view.height = Math.max(-1.57, Math.min(1.57, view.height + up));
    draw();
  };
  const nearer = (by) => {
    view.distance = Math.max(0.05, Math.min(20, view.distance * by));
    draw();
  };
  const canvas = byId("picture");
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons === 0) return reading(event.clientX, event.clientY);
    const share = 2 / canvas.getBoundingClientRect().height;
    if (event.shiftKey) {
      view.across -= event.movementX * share * angle * view.distance;
      view.down += event.movementY * share * angle * view.distance;
      return draw();
    }
    turn(1.5 * event.movementX * share, 1.5 * event.movementY * share);
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    nearer(Math.exp(event.deltaY / 500));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    const zoom = { "+": 0.9, "=": 0.9, "-": 1 / 0.9 }[event.key];
    if (!step && !zoom) return;
    event.preventDefault();
    if (step) turn(...step);
    if (zoom) nearer(zoom);
  });
  byId("layer").addEventListener("change", () => choose().catch(showProblem));
  byId("white").addEventListener("input", scale);
  byId("cells").addEventListener("change", draw);
  window.addEventListener("resize", draw);
  await choose();
};
showFile();
start().catch(showProblem);
