// SPDX-License-Identifier: Apache-2.0
// The page of `earthshine console --serve`: pictures of a scene while its camera, lamps, objects and joints move. A
// picture at once after each move, then better ones while nothing moves.
const token = new URLSearchParams(location.search).get("token");
const size = 256, restMs = 250;
const short = (value, digits = 6) => String(Number(Number(value).toPrecision(digits)));

const startState = () => ({ camera: 0, views: data.cameras.map(({ position, look_at, up, fov_deg }) => ({ position, look_at, up, fov_deg })), set: {} });
let state = startState();
let shown = null; // the last picture: {head, planes, luminance}
let pose = null; // of the last picture at once: {head, layers: {object, depth}}
let isFalse = false, hasHandles = true;
let selected = "camera"; // or "aim", or the key of a movable

// v turned by an angle about a unit axis (Rodrigues).
const turned = (v, axis, angle) => {
  const c = Math.cos(angle), s = Math.sin(angle), along = v.reduce((sum, value, k) => sum + value * axis[k], 0) * (1 - c);
  const side = cross(axis, v);
  return v.map((value, k) => c * value + s * side[k] + along * axis[k]);
};

const view = () => state.views[state.camera];
const orbit = (dx, dy) => {
  const at = view(), from = add(at.position, at.look_at, -1), right = unit(cross(at.up, from)), up = unit(at.up);
  let moved = turned(from, up, -dx);
  const tilted = turned(moved, unit(turned(right, up, -dx)), -dy);
  if (norm(cross(unit(tilted), up)) > 0.02) moved = tilted; // not over the pole
  at.position = add(at.look_at, moved);
};
const pan = (dx, dy) => {
  const at = view(), from = add(at.position, at.look_at, -1), right = unit(cross(at.up, from)), up = unit(cross(from, right));
  const far = 2 * norm(from) * Math.tan((at.fov_deg * Math.PI) / 360), by = add(right.map((v) => -dx * far * v), up, dy * far);
  at.position = add(at.position, by);
  at.look_at = add(at.look_at, by);
};
const dolly = (factor) => {
  const at = view();
  at.position = add(at.look_at, add(at.position, at.look_at, -1), factor);
};

// The camera that the shown marks belong to; the page's own as soon as it is moved.
const aspect = () => data.cameras[state.camera].columns / data.cameras[state.camera].rows;
const seenBy = () => ({ ...(isMoved() || !pose ? view() : pose.head.camera), aspect: aspect() });
const markOf = (key) => pose?.head.marks.find((mark) => mark.key === key);
const valueOf = ({ key, value }) => state.set[key] ?? (value.length === 1 ? value[0] : value);
const nameOf = (key) => (key === "aim" ? "aim" : key.split(".").slice(1, -1).join("."));
const rounded = (value) => Number(value.toFixed(6));

// The selected thing by shares of the picture across and down, and toward the camera; a joint turns.
const moveSelected = (du, dv, depth, nearer = 0) => {
  const camera = seenBy();
  const shift = add(draggedBy(camera, depth, du, dv), axesOf(camera).ahead, -nearer * depth);
  if (selected === "aim") {
    view().look_at = add(view().look_at, shift).map(rounded);
    return;
  }
  const one = data.movables.find(({ key }) => key === selected), mark = markOf(selected);
  if (!mark) return;
  state.set[selected] = add(valueOf(one), inFileAxes(shift, mark.rotation, data.unit_m)).map(rounded);
  mark.at = add(mark.at, shift);
};
const turnSelected = (degrees) => {
  const one = data.movables.find(({ key }) => key === selected);
  state.set[selected] = rounded(valueOf(one) + degrees);
};
const isJoint = () => selected.startsWith("joint.");
const depthOf = (key) => {
  const point = key === "aim" ? view().look_at : markOf(key)?.at;
  return (point && projected(seenBy(), point)?.depth) ?? 0;
};

const handles = () => {
  if (!hasHandles || !pose) return [];
  const camera = seenBy(), marks = pose.head.marks
    .filter(({ key }) => key.startsWith("light.") || key === selected)
    .map(({ key, at }) => ({ key, shape: key.startsWith("light.") ? "lamp" : "other", at }));
  marks.push({ key: "aim", shape: "aim", at: isMoved() ? view().look_at : pose.head.camera.look_at });
  return marks.map((mark) => ({ ...mark, place: projected(camera, mark.at), isSelected: mark.key === selected, name: nameOf(mark.key) }))
    .filter(({ place }) => place && place.u >= 0 && place.u <= 1 && place.v >= 0 && place.v <= 1);
};
const select = (key) => {
  selected = key;
  for (const part of parts) part();
};

// A camera that nobody has moved stays with its joint.
const isMoved = () => Object.keys(view()).some((key) => String(view()[key]) !== String(data.cameras[state.camera][key]));
const requestOf = (level) => {
  const { columns, rows, name } = data.cameras[state.camera], most = Math.max(columns, rows);
  return {
    camera: name, level, view: isMoved() ? view() : undefined, set: state.set,
    columns: Math.max(16, Math.round((size * columns) / most)), rows: Math.max(16, Math.round((size * rows) / most)),
  };
};

const paint = () => {
  if (!shown) return;
  const { planes, luminance, head: { columns, rows } } = shown, canvas = byId("picture");
  const top = isFalse ? falseTopOf(luminance) : null, bytes = pictureBytes(planes, luminance, { top });
  canvas.width = columns;
  canvas.height = rows;
  canvas.getContext("2d").putImageData(new ImageData(bytes, columns, rows), 0, 0);
  byId("screen").style.aspectRatio = `${data.cameras[state.camera].columns} / ${data.cameras[state.camera].rows}`;
  byId("false").setAttribute("aria-pressed", String(isFalse));
  byId("scale").hidden = !isFalse;
  if (isFalse) showScale(top, "cd/m²");
};

const stampOf = ({ kind, columns, rows, seconds, error }) => {
  const stated = error?.estimate ?? null;
  const words = stated !== null ? `error ${short(100 * stated, 2)} %, 95 % sure below ${short(100 * error.bound_95, 2)} %`
    : kind === "patches" ? "coarse: patches of the solution" : "coarse: few samples";
  return `${words} · ${columns} × ${rows} · ${short(seconds, 2)} s`;
};

const fetchPicture = async (level) => {
  const response = await fetch(`/draw?token=${token}`, { method: "POST", body: JSON.stringify(requestOf(level)) });
  if (response.status === 204) return null; // a newer request came
  if (!response.ok) throw new Error(await response.text());
  const bytes = await response.arrayBuffer(), length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const floats = new Float32Array(bytes.slice(4 + length)), count = head.columns * head.rows;
  if (head.layers) {
    const at = 3 * count, each = head.layers.columns * head.layers.rows;
    pose = { head, layers: { object: floats.subarray(at, at + each), depth: floats.subarray(at + each, at + 2 * each) } };
  }
  const planes = [0, 1, 2].map((c) => floats.subarray(c * count, (c + 1) * count));
  const luminance = Float32Array.from(planes[0], (r, i) => Math.max(0, 0.2126 * r + 0.7152 * planes[1][i] + 0.0722 * planes[2][i]));
  return { head, planes, luminance };
};

let version = 0, shownVersion = -1, busy = false, rest = null;
const complain = (text) => {
  byId("problem").hidden = text === "";
  byId("problem").textContent = text;
};
const show = (picture, of) => {
  shown = picture;
  shownVersion = of;
  byId("stamp").textContent = stampOf(picture.head);
  document.body.dataset.level = picture.head.level;
  complain("");
  paint();
  drawHandles(byId("handles"), handles());
};
// A picture at once; the latest move alone if several came meanwhile.
const drawNow = async () => {
  if (busy) return;
  busy = true;
  let drawn = -1;
  while (drawn !== version) {
    drawn = version;
    try {
      const picture = await fetchPicture(0);
      if (picture) show(picture, drawn);
    } catch (error) {
      complain(error.message || "The program has ended.");
    }
  }
  busy = false;
  clearTimeout(rest);
  rest = setTimeout(() => refine(version), restMs);
};
const refine = async (of) => {
  for (let level = 1; level <= data.level_errors.length; ++level) {
    if (of !== version) return;
    try {
      const picture = await fetchPicture(level);
      if (of !== version || !picture) return;
      show(picture, of);
    } catch (error) {
      return complain(error.message || "The program has ended.");
    }
  }
};
const changed = () => {
  ++version;
  clearTimeout(rest);
  for (const part of parts) part();
  drawNow();
};

// A row of number inputs. get: the numbers; set: with all of them.
const makeNumbers = (box, label, get, set) => {
  const row = document.createElement("label"), inputs = get().map((_, k) => {
    const input = Object.assign(document.createElement("input"), { type: "number", step: "any" });
    input.setAttribute("aria-label", `${label}${get().length > 1 ? ` ${"xyz"[k]}` : ""}`);
    input.addEventListener("change", () => {
      const numbers = inputs.map((one) => Number(one.value));
      if (inputs.every((one) => one.value !== "") && numbers.every(Number.isFinite)) set(numbers);
      changed();
    });
    return input;
  });
  row.append(Object.assign(document.createElement("span"), { textContent: label }), ...inputs);
  if (inputs.length > 1) row.style.gridTemplateColumns = `76px repeat(${inputs.length}, 1fr)`;
  box.append(row);
  return () => get().forEach((value, k) => { if (document.activeElement !== inputs[k]) inputs[k].value = short(value, 5); });
};

const parts = [];
const wordsOf = () => {
  const { name } = data.cameras[state.camera], at = view(), numbers = (list) => `[${list.map((v) => short(v)).join(", ")}]`;
  const sets = Object.entries(state.set).map(([key, value]) => `${key}=${Array.isArray(value) ? numbers(value) : short(value)}`);
  return `earthshine render '${data.path}' --camera '${name}'${sets.map((set) => ` \\\n  --set '${set}'`).join("")}\n\n# camera ${name}, in m\n` +
    `position = ${numbers(at.position)}\nlook_at = ${numbers(at.look_at)}\nfov_deg = ${short(at.fov_deg)}\n`;
};

const makeMove = () => {
  const list = byId("which"), box = byId("move"), keys = ["camera", "aim", ...data.movables.map(({ key }) => key)];
  for (const key of keys) list.add(new Option(key === "camera" ? "Camera" : key === "aim" ? "Camera's aim" : key.split(".").slice(0, -1).join(" ")));
  list.addEventListener("change", () => select(keys[list.selectedIndex]));
  let filled = null, update = () => {};
  return () => {
    list.selectedIndex = keys.indexOf(selected);
    byId("hint").textContent = hints[selected === "camera" ? "camera" : isJoint() ? "joint" : "thing"];
    if (filled !== selected) {
      filled = selected;
      box.replaceChildren();
      const one = data.movables.find(({ key }) => key === selected);
      update = one ? makeNumbers(box, one.key.split(".").at(-1), () => [valueOf(one)].flat(),
        (numbers) => { state.set[one.key] = one.value.length === 1 ? numbers[0] : numbers; }) : () => {};
    }
    update();
  };
};
const hints = {
  camera: "Drag turns about the aim, with Shift it pans; the wheel goes nearer. Click a thing to select it.",
  thing: "Drag it, or press arrow keys: parallel to the picture, with Shift up and down: farther and nearer. Escape: the camera.",
  joint: "Drag around its pivot, or press arrow keys to turn it. Escape: the camera.",
};

// Where the pointer is in the picture, as shares.
const placeOf = (event) => {
  const { left, top, width, height } = byId("picture").getBoundingClientRect();
  return { u: (event.clientX - left) / width, v: (event.clientY - top) / height, width, height };
};
// The handle at a place, or the movable object there; null: neither.
const thingAt = (place) => {
  const off = (mark) => Math.hypot((mark.place.u - place.u) * place.width, (mark.place.v - place.v) * place.height);
  const near = handles().filter((mark) => off(mark) <= 12).sort((a, b) => off(a) - off(b))[0];
  if (near) return { key: near.key, depth: near.place.depth, isHandle: true };
  const pixel = pose && hasHandles ? pixelAt(pose, place) : null, mark = pixel && pose.head.marks.find(({ object }) => object === pixel.object);
  return mark ? { key: mark.key, depth: pixel.depth, isHandle: false } : null;
};

// Handles and the selected object are dragged, and a joint wherever the drag begins; otherwise the camera. A click
// selects.
const makePointer = (canvas) => {
  let drag = null;
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    const place = placeOf(event), thing = thingAt(place);
    const isTaken = event.button === 0 && thing && (thing.isHandle || thing.key === selected);
    if (isTaken) select(thing.key);
    drag = { place, thing, isMoved: false, moves: (isTaken || (isJoint() && event.button === 0)) && selected !== "camera", depth: thing?.depth };
  });
  canvas.addEventListener("pointermove", (event) => {
    const place = placeOf(event);
    if (!drag) {
      const thing = thingAt(place);
      byId("under").textContent = thing ? nameOf(thing.key) : "";
      return;
    }
    const du = place.u - drag.place.u, dv = place.v - drag.place.v;
    if (!drag.isMoved && Math.hypot(du * place.width, dv * place.height) < 3) return;
    drag.isMoved = true;
    if (drag.moves && isJoint()) turnSelected(turnedBy(seenBy(), markOf(selected), drag.place, place));
    else if (drag.moves) moveSelected(du, dv, drag.depth);
    else if (event.shiftKey || event.buttons === 2 || event.buttons === 4) pan(du, dv);
    else orbit(3 * du, 3 * dv);
    drag.place = place;
    changed();
  });
  const end = (event) => {
    if (drag && !drag.isMoved && event.type === "pointerup") select(drag.thing?.key ?? "camera");
    drag = null;
  };
  for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, end);
  canvas.addEventListener("pointerleave", () => { byId("under").textContent = ""; });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    dolly(Math.exp(event.deltaY / 1000));
    changed();
  }, { passive: false });
};
const makeKeys = (canvas) => {
  canvas.addEventListener("keydown", (event) => {
    const arrow = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (arrow && isJoint()) turnSelected(arrow[0] - arrow[1]);
    else if (arrow && selected !== "camera") {
      const isAlong = event.shiftKey && arrow[1] !== 0;
      moveSelected(isAlong ? 0 : arrow[0] / 64, isAlong ? 0 : arrow[1] / 64, depthOf(selected), isAlong ? arrow[1] / 64 : 0);
    } else if (arrow) event.shiftKey ? pan(...arrow.map((one) => one / 10)) : orbit(...arrow.map((one) => one / 10));
    else if (event.key === "+" || event.key === "-") dolly(event.key === "+" ? 0.9 : 1 / 0.9);
    else if (event.key === "Escape") return select("camera");
    else return;
    event.preventDefault();
    changed();
  });
};

const begin = () => {
  byId("name").textContent = data.scene;
  document.title = `${data.scene}: live preview`;
  data.cameras.forEach(({ name }, k) => {
    const button = Object.assign(document.createElement("button"), { textContent: name });
    button.setAttribute("role", "radio");
    button.addEventListener("click", () => { state.camera = k; pose = null; changed(); });
    byId("cameras").append(button);
  });
  parts.push(() => [...byId("cameras").children].forEach((button, k) => button.setAttribute("aria-checked", String(k === state.camera))));
  for (const [label, key] of [["Position", "position"], ["Look at", "look_at"]]) {
    parts.push(makeNumbers(byId("camera"), label, () => view()[key], (numbers) => { view()[key] = numbers; }));
  }
  parts.push(makeNumbers(byId("camera"), "Field, deg", () => [view().fov_deg], ([angle]) => { view().fov_deg = Math.min(170, Math.max(1, angle)); }));
  parts.push(makeMove(), () => { byId("words").value = wordsOf(); }, () => drawHandles(byId("handles"), handles()));
  const canvas = byId("picture");
  makePointer(canvas);
  makeKeys(canvas);
  const toggle = () => { isFalse = !isFalse; paint(); };
  const toggleHandles = () => {
    hasHandles = !hasHandles;
    byId("hold").setAttribute("aria-pressed", String(hasHandles));
    select(selected);
  };
  byId("hold").addEventListener("click", toggleHandles);
  addEventListener("resize", () => drawHandles(byId("handles"), handles()));
  const reset = () => { state = { ...startState(), camera: state.camera }; changed(); };
  byId("false").addEventListener("click", toggle);
  byId("reset").addEventListener("click", reset);
  document.addEventListener("keydown", (event) => {
    if (event.target.matches("input, select, textarea") || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "f") toggle();
    if (event.key === "h") toggleHandles();
    if (event.key === "0") reset();
  });
  changed();
};
begin();

// For tests.
globalThis.earthshineLive = {
  level: () => (shownVersion === version ? shown.head.level : -1),
  // Means of 8 by 8 parts of the picture, cd/m2.
  parts: () => {
    const { columns, rows } = shown.head, sums = Array(64).fill(0), counts = Array(64).fill(0);
    shown.luminance.forEach((value, i) => {
      const part = 8 * Math.floor((8 * Math.floor(i / columns)) / rows) + Math.floor((8 * (i % columns)) / columns);
      sums[part] += value;
      ++counts[part];
    });
    return sums.map((sum, k) => sum / counts[k]);
  },
  error: () => shown.head.error,
  selected: () => selected,
  set: () => state.set,
  view,
  place: (key) => projected(seenBy(), markOf(key).at),
  pixelAt: (place) => pixelAt(pose, place),
  objectAt: (place) => pose.head.marks.find((mark) => mark.object === pixelAt(pose, place)?.object)?.key ?? null,
};
