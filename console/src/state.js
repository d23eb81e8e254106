// SPDX-License-Identifier: Apache-2.0
// What the controls say, as one plain value: undo keeps copies of it and the address's fragment is its text.
const data = JSON.parse(document.getElementById("data").textContent);

// A fader's law: the square of its way, 1 in the middle.
const mostLevel = 4;
const levelOfWay = (way) => Number(short((way / 500) ** 2, 3));
const wayOfLevel = (level) => 500 * Math.sqrt(level);

const plainState = () => ({
  camera: 0,
  place: 0,
  level: {}, // of a light by name; 1 where it is not here
  tint: {}, // "#rrggbb" of a light by name
  off: {}, // true for a light by name
  group: {}, // level of a group's master
  view: "clean", // or "monitor"
  white: null, // cd/m^2 of the clean picture's white; null: its own exposure
  top: null, // power of ten of the brightest false colour; null: no false colours
  model: "", // preset; "": the camera's own
  camera_set: {}, // settings changed on the model
  monitor_set: {},
  noise: "off", // "frozen", "live"
});

// A page of a study begins with its first lamp setting.
const startState = () => (data.study ? withSetting(plainState(), 0) : plainState());

// The lamp setting of a study as levels and tints.
const withSetting = (state, setting) => {
  const changed = { ...state, level: {}, tint: {}, off: {}, group: {} };
  data.study.settings[setting].factors.forEach((factor, k) => {
    const { name, kind } = data.lights[k], most = Math.max(...factor);
    if (kind === "ambient") return;
    if (most !== 1) changed.level[name] = Math.min(most, mostLevel);
    if (most > 0 && factor.some((value) => value !== most)) {
      changed.tint[name] = `#${factor.map((value) => srgbByte(value / most).toString(16).padStart(2, "0")).join("")}`;
    }
  });
  return changed;
};

// The number of the study's lamp setting that the state has, with each camera's own model; -1: none. A tint has 8 bits.
const settingOf = (state) => {
  if (!data.study || state.model || Object.keys({ ...state.camera_set, ...state.monitor_set }).length > 0) return -1;
  const factors = factorsOf(state);
  return data.study.settings.findIndex((setting) => setting.factors.every((wanted, k) =>
    data.lights[k].kind === "ambient" || wanted.every((value, c) => Math.abs(value - factors[k][c]) <= 0.01 * Math.max(...wanted))));
};

// [verdict, reasons] by target of a camera in the study's condition.
const judgedByStudy = (camera, setting, place) =>
  Object.entries(data.study.judged[data.cameras[camera].name] ?? {}).map(([name, list]) => [name, list[setting * data.study.places + place]]);

const lightLevel = (state, { name, group }) =>
  state.off[name] ? 0 : (state.level[name] ?? 1) * (group ? state.group[group] ?? 1 : 1);

// The tint's hue: its largest component is 1.
const tintFactor = (hex) => {
  if (!hex) return [1, 1, 1];
  const rgb = [1, 3, 5].map((at) => linearOfSrgb(parseInt(hex.slice(at, at + 2), 16) / 255));
  const largest = Math.max(...rgb);
  return largest > 0 ? rgb.map((value) => value / largest) : [1, 1, 1];
};

const factorsOf = (state) =>
  data.lights.map((light) => tintFactor(state.tint[light.name]).map((value) => value * lightLevel(state, light)));

const modelOf = (state) => {
  const base = data.presets.find(({ name }) => name === state.model) ?? data.cameras[state.camera].cctv;
  return {
    name: base.name,
    camera: { ...base.camera, ...state.camera_set },
    monitor: { ...base.monitor, ...state.monitor_set },
  };
};

// Entries of a state that differ from the start, as [key, text].
const mapsOfState = { level: "l", tint: "t", off: "off", group: "g", camera_set: "c", monitor_set: "m" };
const textOfState = (state) => {
  const words = new URLSearchParams(), start = plainState();
  if (data.cameras.length > 1) words.set("camera", data.cameras[state.camera].name);
  if (data.places.length > 1) words.set("place", state.place);
  for (const key of ["view", "white", "top", "model", "noise"]) {
    if (state[key] !== start[key]) words.set(key, state[key]);
  }
  for (const [key, letter] of Object.entries(mapsOfState)) {
    for (const [name, value] of Object.entries(state[key])) words.set(`${letter}.${name}`, value);
  }
  return words.toString();
};

// A text of another page, or nonsense, leaves what it does not know.
const stateOfText = (text) => {
  const state = text === "" ? startState() : plainState(), model = () => modelOf(state), words = new URLSearchParams(text);
  const number = (value, low, high) => (value !== "" && value >= low && value <= high ? Number(value) : null);
  const camera = data.cameras.findIndex(({ name }) => name === words.get("camera"));
  state.camera = Math.max(0, camera);
  state.place = Math.round(number(words.get("place") ?? "", 0, data.places.length - 1) ?? 0);
  if (words.get("view") === "monitor") state.view = "monitor";
  state.white = number(words.get("white") ?? "", 1e-9, 1e9);
  state.top = number(words.get("top") ?? "", -12, 12);
  if (data.presets.some(({ name }) => name === words.get("model"))) state.model = words.get("model");
  if (["frozen", "live"].includes(words.get("noise"))) state.noise = words.get("noise");
  const lights = new Set(data.lights.map(({ name }) => name)), groups = new Set(data.lights.map(({ group }) => group));
  for (const [key, value] of words) {
    const at = key.indexOf("."), name = key.slice(at + 1), level = number(value, 0, mostLevel);
    switch (at < 0 ? "" : key.slice(0, at)) {
      case "l": if (lights.has(name) && level !== null) state.level[name] = level; break;
      case "g": if (groups.has(name) && level !== null) state.group[name] = level; break;
      case "t": if (lights.has(name) && /^#[0-9a-f]{6}$/.test(value)) state.tint[name] = value; break;
      case "off": if (lights.has(name)) state.off[name] = true; break;
      case "c": takeSetting(state.camera_set, model().camera, name, value); break;
      case "m": takeSetting(state.monitor_set, model().monitor, name, value); break;
    }
  }
  return state;
};

// A setting as its default is: a number of its control's range, or one of its words.
const takeSetting = (into, settings, name, value) => {
  const control = settingControls.find((one) => one.name === name);
  if (!control || !(name in settings)) return;
  if (control.words) {
    if (control.words.includes(value)) into[name] = value;
  } else if (value !== "" && value >= control.low && value <= control.high) {
    into[name] = Number(value);
  }
};

// The settings that have a control. of: table of the model.
const settingControls = [
  { of: "camera_set", part: "camera", name: "iris", label: "Iris", words: ["fixed", "peak", "normal", "average"] },
  { of: "camera_set", part: "camera", name: "f_number", label: "f-number", low: 0.5, high: 1e6, when: (c) => c.iris === "fixed" },
  { of: "camera_set", part: "camera", name: "gain_db", label: "Gain", unit: "dB", low: 0, high: 80, when: (c) => c.iris === "fixed" },
  { of: "camera_set", part: "camera", name: "gain_max_db", label: "Gain, most", unit: "dB", low: 0, high: 80, when: (c) => c.iris !== "fixed" },
  { of: "camera_set", part: "camera", name: "gamma", label: "Camera gamma", low: 0.2, high: 5 },
  { of: "monitor_set", part: "monitor", name: "gamma", label: "Monitor gamma", low: 0.2, high: 5 },
  { of: "monitor_set", part: "monitor", name: "white_luminance", label: "Screen white", unit: "cd/m²", low: 1e-3, high: 1e5 },
  { of: "monitor_set", part: "monitor", name: "room_illuminance", label: "Room light", unit: "lx", low: 0, high: 1e6 },
];

const history = { past: [], future: [] };
let state = startState();
const copyOf = (value) => structuredClone(value);

// Changes the state by change(state). `while`: a fader that is still moving makes one step of undo of all its moves.
let moving = null;
const changeState = (change, whileMoving = null) => {
  const before = copyOf(state);
  change(state);
  if (JSON.stringify(before) === JSON.stringify(state)) return;
  if (whileMoving === null || moving !== whileMoving) history.past.push(before);
  if (history.past.length > 200) history.past.shift();
  history.future = [];
  moving = whileMoving;
  stateChanged();
};
const endMove = () => { moving = null; };
const stepHistory = (from, to) => {
  if (from.length === 0) return;
  to.push(copyOf(state));
  state = from.pop();
  moving = null;
  stateChanged();
};
const undo = () => stepHistory(history.past, history.future);
const redo = () => stepHistory(history.future, history.past);
