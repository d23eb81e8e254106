// SPDX-License-Identifier: Apache-2.0
// Handles of the live preview: what is under the pointer, where things are in the picture, and by how much a drag in the
// plane through a point parallel to the picture moves it. The camera is taken as a pinhole, without its lens' distortion.
const add = (a, b, times = 1) => a.map((value, k) => value + times * b[k]);
const dot = (a, b) => a.reduce((sum, value, k) => sum + value * b[k], 0);
const norm = (a) => Math.hypot(...a);
const unit = (a) => a.map((value) => value / norm(a));

// camera: {position, look_at, up, fov_deg, aspect}, aspect: columns over rows.
const axesOf = ({ position, look_at, up, fov_deg, aspect }) => {
  const ahead = unit(add(look_at, position, -1)), right = unit(cross(ahead, up)), half = Math.tan((fov_deg * Math.PI) / 360);
  return { ahead, right, above: cross(right, ahead), halfWidth: half * aspect, halfHeight: half };
};
// u and v from 0 to 1 across and down, depth in m along the camera's axis; null behind the camera.
const projected = (camera, point) => {
  const { ahead, right, above, halfWidth, halfHeight } = axesOf(camera), from = add(point, camera.position, -1), depth = dot(from, ahead);
  if (!(depth > 1e-6)) return null;
  return { u: 0.5 + dot(from, right) / (2 * depth * halfWidth), v: 0.5 - dot(from, above) / (2 * depth * halfHeight), depth };
};
// In m, of a point at that depth that moves by du and dv in the picture.
const draggedBy = (camera, depth, du, dv) => {
  const { right, above, halfWidth, halfHeight } = axesOf(camera);
  return add(right.map((value) => 2 * depth * halfWidth * du * value), above, -2 * depth * halfHeight * dv);
};
// rotation: columns of the joint's rotation, by which the file's axes are turned.
const inFileAxes = (shift, rotation, metresPerUnit) => (rotation ? rotation.map((column) => dot(column, shift)) : shift).map((value) => value / metresPerUnit);
// By the right-hand rule, of a turn about an axis that moves the pointer from one place to another as seen from its pivot.
const turnedBy = (camera, { at, axis }, from, to) => {
  const pivot = projected(camera, at);
  if (!pivot) return 0;
  const angle = ({ u, v }) => Math.atan2(-(v - pivot.v), (u - pivot.u) * camera.aspect);
  const turn = ((angle(to) - angle(from)) * 180) / Math.PI, toCamera = dot(axis, add(camera.position, at, -1)) >= 0 ? 1 : -1;
  return toCamera * (((turn + 540) % 360) - 180);
};

// The object and depth of the pixel at u, v.
const pixelAt = ({ layers, head }, { u, v }) => {
  const { columns, rows } = head.layers, x = Math.floor(u * columns), y = Math.floor(v * rows);
  if (!(x >= 0 && x < columns && y >= 0 && y < rows)) return null;
  const k = y * columns + x;
  return layers.object[k] < 0 ? null : { object: layers.object[k], depth: layers.depth[k] };
};

// Rings at lamps, a cross at the aim, a square at another thing that is selected.
const shapes = {
  lamp: (x, y) => `<circle cx="${x}" cy="${y}" r="5"/>`,
  aim: (x, y) => `<path d="M${x - 9} ${y}h6m6 0h6M${x} ${y - 9}v6m0 6v6"/>`,
  other: (x, y) => `<path d="M${x - 7} ${y - 7}h14v14h-14z"/>`,
};
// marks: [{shape, place: {u, v}, isSelected, name}].
const drawHandles = (svg, marks) => {
  const { clientWidth: width, clientHeight: height } = svg.parentElement;
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.innerHTML = marks.map(({ shape, place, isSelected }) => {
    const drawn = shapes[shape](Math.round(place.u * width), Math.round(place.v * height));
    return `<g class="${shape}${isSelected ? " selected" : ""}"><g class="shade">${drawn}</g>${drawn}</g>`;
  }).join("");
  for (const { place, isSelected, name } of marks) {
    if (!isSelected) continue;
    const text = document.createElementNS("http://www.w3.org/2000/svg", "text"), isRight = place.u > 0.7;
    text.textContent = name;
    text.setAttribute("x", place.u * width + (isRight ? -12 : 12));
    text.setAttribute("y", Math.min(height - 26, Math.max(14, place.v * height + 4)));
    text.setAttribute("text-anchor", isRight ? "end" : "start");
    svg.append(text);
  }
};
