// SPDX-License-Identifier: Apache-2.0
// The page of `earthshine console --serve`: pictures of a scene while its camera, lamps, objects and joints move. A
// picture at once after each move, then better ones while nothing moves.
const token = new URLSearchParams(location.search).get("token");
const size = 256, restMs = 250;
const short = (value, digits = 6) => String(Number(Number(value).toPrecision(digits)));

const startState = () => ({ camera: 0, views: data.cameras.map(({ position, look_at, up, fov_deg }) => ({ position, look_at, up, fov_deg })), set: {} });
let state = startState();
let shown = null; // the last picture: {head, planes, luminance}
let isFalse = false;

const add = (a, b, times = 1) => a.map((value, k) => value + times * b[k]);
const norm = (a) => Math.hypot(...a);
const unit = (a) => a.map((value) => value / norm(a));
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

// A camera that nobody has moved stays with its joint.
const requestOf = (level) => {
  const start = data.cameras[state.camera], { columns, rows, name } = start, most = Math.max(columns, rows), at = view();
  const isMoved = Object.keys(at).some((key) => String(at[key]) !== String(start[key]));
  return {
    camera: name, level, view: isMoved ? at : undefined, set: state.set,
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
  if (response.status === 409) return null; // a newer request
  if (!response.ok) throw new Error(await response.text());
  const bytes = await response.arrayBuffer(), length = new DataView(bytes).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  const floats = new Float32Array(bytes.slice(4 + length)), count = head.columns * head.rows;
  const planes = [0, 1, 2].map((c) => floats.subarray(c * count, (c + 1) * count));
  const luminance = Float32Array.from(planes[0], (r, i) => Math.max(0, 0.2126 * r + 0.7152 * planes[1][i] + 0.0722 * planes[2][i]));
  return { head, planes, luminance };
};

let version = 0, busy = false, rest = null;
const complain = (text) => {
  byId("problem").hidden = text === "";
  byId("problem").textContent = text;
};
const show = (picture) => {
  shown = picture;
  byId("stamp").textContent = stampOf(picture.head);
  document.body.dataset.level = picture.head.level;
  complain("");
  paint();
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
      if (picture) show(picture);
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
      show(picture);
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
  const select = byId("which"), box = byId("move");
  const fill = () => {
    box.replaceChildren();
    const one = data.movables[select.selectedIndex];
    if (!one) return () => {};
    const isOne = one.value.length === 1;
    return makeNumbers(box, one.key.split(".").at(-1), () => (isOne ? [state.set[one.key] ?? one.value[0]] : state.set[one.key] ?? one.value),
      (numbers) => { state.set[one.key] = isOne ? numbers[0] : numbers; });
  };
  let update = () => {};
  for (const { key } of data.movables) select.add(new Option(key.split(".").slice(0, -1).join(" ")));
  select.addEventListener("change", () => { update = fill(); update(); });
  if (data.movables.length === 0) select.hidden = true;
  update = fill();
  return () => update();
};

const begin = () => {
  byId("name").textContent = data.scene;
  document.title = `${data.scene}: live preview`;
  data.cameras.forEach(({ name }, k) => {
    const button = Object.assign(document.createElement("button"), { textContent: name });
    button.setAttribute("role", "radio");
    button.addEventListener("click", () => { state.camera = k; changed(); });
    byId("cameras").append(button);
  });
  parts.push(() => [...byId("cameras").children].forEach((button, k) => button.setAttribute("aria-checked", String(k === state.camera))));
  for (const [label, key] of [["Position", "position"], ["Look at", "look_at"]]) {
    parts.push(makeNumbers(byId("camera"), label, () => view()[key], (numbers) => { view()[key] = numbers; }));
  }
  parts.push(makeNumbers(byId("camera"), "Field, deg", () => [view().fov_deg], ([angle]) => { view().fov_deg = Math.min(170, Math.max(1, angle)); }));
  parts.push(makeMove(), () => { byId("words").value = wordsOf(); });
  const canvas = byId("picture");
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    const [dx, dy] = [event.movementX / canvas.clientWidth, event.movementY / canvas.clientHeight];
    if (event.shiftKey || event.buttons === 2 || event.buttons === 4) pan(dx, dy);
    else orbit(3 * dx, 3 * dy);
    changed();
  });
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    dolly(Math.exp(event.deltaY / 1000));
    changed();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
    if (step) event.shiftKey ? pan(...step) : orbit(...step);
    else if (event.key === "+" || event.key === "-") dolly(event.key === "+" ? 0.9 : 1 / 0.9);
    else return;
    event.preventDefault();
    changed();
  });
  const toggle = () => { isFalse = !isFalse; paint(); };
  const reset = () => { state = { ...startState(), camera: state.camera }; changed(); };
  byId("false").addEventListener("click", toggle);
  byId("reset").addEventListener("click", reset);
  document.addEventListener("keydown", (event) => {
    if (event.target.matches("input, select, textarea") || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.key === "f") toggle();
    if (event.key === "0") reset();
  });
  changed();
};
begin();
