// SPDX-License-Identifier: Apache-2.0
// Puts the page together, draws when something has changed, and listens to keys.
const views = new Map(); // camera -> promise of its view
const viewOf = (camera) => {
  if (!views.has(camera)) views.set(camera, loadView(data.cameras[camera]));
  return views.get(camera);
};

let drawn = null; // what the last drawing found: {light, monitor, tone}
let kept = null; // the state that the split compares with
let split = null; // where the split stands, 0 to 1; null: none
let probe = null; // pixel under the pointer
let frame = 0; // of live noise
let wanted = false;
const shown = { strips: [], parts: [] };
const offscreen = document.createElement("canvas");

const stateChanged = () => {
  for (const part of shown.parts) part();
  try {
    globalThis.history.replaceState(null, "", `#${textOfState(state)}`);
  } catch {
    // A browser may refuse after hundreds of changes in half a minute; the next one is written.
  }
  requestDraw();
};

const requestDraw = () => {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(async () => {
    wanted = false;
    const view = await viewOf(state.camera);
    if (view.camera === data.cameras[state.camera]) draw(view);
  });
};

const noiseFrame = () => ({ off: null, frozen: 0, live: frame })[state.noise];

const draw = (view) => {
  const start = performance.now(), canvas = byId("picture");
  const light = lightOf(view, state), now = drawPicture(offscreen, light, state, noiseFrame());
  const { clientWidth: width, clientHeight: height } = canvas, ratio = devicePixelRatio || 1;
  canvas.width = Math.max(1, Math.round(width * ratio));
  canvas.height = Math.max(1, Math.round(height * ratio));
  const context = canvas.getContext("2d");
  context.imageSmoothingEnabled = now.shown.width > canvas.width || state.view === "monitor";
  context.drawImage(now.shown, 0, 0, canvas.width, canvas.height);
  if (split !== null && kept) {
    const old = { ...kept, camera: state.camera, view: state.view, top: state.top };
    const before = drawPicture(offscreen, lightOf(view, old), old, noiseFrame()).shown;
    context.drawImage(before, 0, 0, before.width * split, before.height, 0, 0, canvas.width * split, canvas.height);
  }
  drawn = { light, ...now };
  showAll();
  if (judged !== judgedBy()) judgeLater();
  const words = [state.view === "monitor" ? modelOf(state).name : "clean", `${view.columns} × ${view.rows}`,
    `noise of the rendering ${short(100 * view.camera.relative_noise, 2)} %`, `${Math.round(performance.now() - start)} ms`];
  byId("stamp").textContent = words.join(" · ");
  if (state.noise === "live" && state.view === "monitor" && !document.hidden) {
    ++frame;
    requestDraw();
  }
};

const showAll = () => {
  const { light } = drawn, { total, shares } = sharesOf(light);
  for (const strip of shown.strips) strip.show(shares);
  byId("total").textContent = `mean ${luminanceText(total)}`;
  showMeter(byId("meter"), drawn);
  showReading(byId("reading"), light, probe);
  showScale(byId("scale"), state.top);
  const line = byId("line");
  line.hidden = split === null || !kept;
  if (!line.hidden) line.style.left = `${100 * split}%`;
  byId("split").setAttribute("aria-pressed", String(!line.hidden));
  byId("false").setAttribute("aria-pressed", String(state.top !== null));
  byId("undo").disabled = history.past.length === 0;
  byId("redo").disabled = history.future.length === 0;
};

// Verdicts cost more than a picture: they follow when the controls have rested, and the reasons one by one after them.
// What the verdicts depend on.
let judged = null;
const judgedBy = () => JSON.stringify(["camera", "place", "level", "tint", "off", "group", "model", "camera_set", "monitor_set"].map((key) => state[key]));
let judging = 0; // number of the drawing whose verdicts are under way
let rest = null;
const restMs = 60;
const judgeLater = () => {
  const number = ++judging;
  judged = judgedBy();
  clearTimeout(rest);
  byId("targets").setAttribute("aria-busy", "true");
  rest = setTimeout(() => judge(drawn.light, copyOf(state), number), restMs);
};
const judge = async (light, of, number) => {
  const figures = targetFigures(light, of), reasons = new Map();
  const setting = settingOf(of);
  if (setting >= 0) {
    for (const [name, found] of judgedByStudy(of.camera, setting, of.place)) if (found) reasons.set(name, found[1]);
  }
  showTargets(byId("targets"), figures, reasons);
  for (const found of figures) {
    if (reasons.has(found.name)) continue;
    const target = light.view.targets.find(({ name }) => name === found.name);
    const steps = reasonSteps(light, of, target, found);
    for (;;) {
      const { done, value } = steps.next();
      if (done) {
        reasons.set(found.name, value);
        break;
      }
      await new Promise((later) => { setTimeout(later); });
      if (number !== judging) return;
    }
    showTargets(byId("targets"), figures, reasons);
  }
  byId("targets").setAttribute("aria-busy", "false");
};

const toggleFalse = () =>
  changeState((to) => { to.top = to.top === null ? falseTopOf(drawn.light.luminance) : null; });
const keep = () => {
  kept = copyOf(state);
  split ??= 0.5;
  requestDraw();
};
const toggleSplit = () => {
  if (!kept) return keep();
  split = split === null ? 0.5 : null;
  requestDraw();
};
const moveSplit = (by) => {
  if (split === null) return;
  split = Math.min(1, Math.max(0, split + by));
  requestDraw();
};
const isDark = () => getComputedStyle(document.documentElement).colorScheme === "dark";
const toggleTheme = () => {
  document.documentElement.dataset.theme = isDark() ? "light" : "dark";
  byId("theme").textContent = isDark() ? "Light" : "Dark";
};
const chooseCamera = (camera) => {
  probe = null;
  changeState((to) => {
    to.camera = Number(camera);
    Object.assign(to, { camera_set: {}, monitor_set: {} });
  });
};
const nextWord = (words, word) => words[(words.indexOf(word) + 1) % words.length];
const stepPlace = (by) =>
  changeState((to) => { to.place = (to.place + by + data.places.length) % data.places.length; });

const switchFocused = () => {
  const button = document.activeElement?.closest(".strip")?.querySelector(".off");
  if (button) button.click();
};

// [keys, what they do, how it is said].
const keyTable = [
  [["1", "…", "9"], null, "camera"],
  [["m"], () => changeState((to) => { to.view = to.view === "clean" ? "monitor" : "clean"; }), "clean or monitor"],
  [["f"], toggleFalse, "false colours"],
  [["k"], keep, "keep this picture"],
  [["b"], toggleSplit, "split: kept picture on the left"],
  [["["], () => moveSplit(-0.05), "split to the left"],
  [["]"], () => moveSplit(0.05), "split to the right"],
  [["i"], () => setSetting(settingControls[0], nextWord(settingControls[0].words, modelOf(state).camera.iris)), "next iris mode"],
  [["n"], () => changeState((to) => { to.noise = nextWord(["off", "frozen", "live"], to.noise); }), "noise off, frozen, live"],
  [[","], () => stepPlace(-1), "back along the orbit"],
  [["."], () => stepPlace(1), "on along the orbit"],
  [["o"], switchFocused, "switch the light whose fader has the focus"],
  [["z"], undo, "undo"],
  [["Z"], redo, "redo"],
  [["c"], showCopies, "link, lamps table and command"],
  [["d"], toggleTheme, "dark or light"],
  [["?"], () => byId("keys").showModal(), "this list"],
];

const onKey = (event) => {
  if (event.altKey || document.querySelector("dialog[open]")) return;
  const typing = event.target.matches("input[type=number], select, textarea");
  if (event.ctrlKey || event.metaKey) {
    if (typing || !["z", "Z", "y"].includes(event.key)) return;
    event.preventDefault();
    return event.key === "z" ? undo() : redo();
  }
  if (typing) return;
  if (/^[1-9]$/.test(event.key) && event.key <= data.cameras.length) return chooseCamera(event.key - 1);
  const entry = keyTable.find(([keys]) => keys.includes(event.key));
  if (!entry?.[1]) return;
  event.preventDefault();
  entry[1]();
};

// The pixel at a place of the canvas, in fractions of it.
const probeAt = (x, y) => {
  if (!drawn) return;
  const { columns, rows } = drawn.light.view;
  const inside = (value, size) => Math.min(size - 1, Math.max(0, Math.floor(value * size)));
  probe = [inside(x, columns), inside(y, rows)];
  showReading(byId("reading"), drawn.light, probe);
};
const listenToPicture = () => {
  const canvas = byId("picture");
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  };
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = place(event);
    if (event.buttons && split !== null) {
      split = Math.min(1, Math.max(0, x));
      requestDraw();
    }
    probeAt(x, y);
  });
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!step || !drawn) return;
    event.preventDefault();
    const { columns, rows } = drawn.light.view, far = event.shiftKey ? 16 : 1;
    const [x, y] = probe ?? [columns >> 1, rows >> 1];
    probeAt((x + far * step[0] + 0.5) / columns, (y + far * step[1] + 0.5) / rows);
  });
};

// The largest canvas of the picture's shape in its box.
const fitPicture = () => {
  const { columns, rows } = data.cameras[state.camera], screen = byId("screen"), box = screen.parentElement;
  const others = [...box.children].filter((child) => child !== screen && !child.hidden)
    .reduce((sum, child) => sum + child.getBoundingClientRect().height, 0);
  const width = Math.min(box.clientWidth, ((box.clientHeight - others) * columns) / rows);
  screen.style.width = `${Math.floor(width)}px`;
  screen.style.height = `${Math.floor((width * rows) / columns)}px`;
};

const problem = (text) => {
  byId("problem").hidden = false;
  byId("problem").textContent = text;
};

const begin = () => {
  if (typeof DecompressionStream !== "function") return problem("This browser is too old: it has no DecompressionStream.");
  state = stateOfText(location.hash.slice(1));
  byId("scene").textContent = data.scene;
  shown.strips = stripsOf().map(makeStrip);
  byId("strips").append(...shown.strips.map(({ element }) => element));
  shown.parts = [
    makeChoice(byId("cameras"), data.cameras.map(({ name }, k) => [k, name, `Camera ${name} (${k + 1})`]), () => state.camera, chooseCamera),
    makeChoice(byId("views"), [["clean", "Clean", "What the camera sees (m)"], ["monitor", "Monitor", "What its CCTV monitor shows (m)"]],
      () => state.view, (view) => changeState((to) => { to.view = view; })),
    makePanel(byId("panel")),
    makeOrbit(byId("orbit")),
    makeSettings(byId("setting")),
    fitPicture,
  ];
  byId("keylist").append(...keyTable.flatMap(([keys, , words]) => [make("dt", { textContent: keys.join(" ") }), make("dd", { textContent: words })]),
    make("dt", { textContent: "← ↑ → ↓" }), make("dd", { textContent: "on the picture: the pixel that is read; with Shift 16 pixels" }));
  const clicks = { false: toggleFalse, keep, split: toggleSplit, undo, redo, copy: showCopies, theme: toggleTheme, help: () => byId("keys").showModal() };
  for (const [id, action] of Object.entries(clicks)) byId(id).addEventListener("click", action);
  byId("theme").textContent = isDark() ? "Light" : "Dark";
  document.addEventListener("keydown", onKey);
  addEventListener("hashchange", () => {
    if (location.hash.slice(1) === textOfState(state)) return;
    state = stateOfText(location.hash.slice(1));
    stateChanged();
  });
  new ResizeObserver(() => { fitPicture(); requestDraw(); }).observe(byId("stage"));
  document.addEventListener("visibilitychange", requestDraw);
  listenToPicture();
  stateChanged();
};

// For tests and for who wants numbers: pictures of a fragment's state, from the functions that the page draws with.
globalThis.earthshineConsole = {
  async clean(text, useGpu) {
    const of = stateOfText(text), light = lightOf(await viewOf(of.camera), of), { view, active, luminance } = light;
    const tone = toneOf(luminance, of.white);
    const sums = [0, 1, 2].map((c) => sumColour(view, active, c));
    let bytes = cleanBytes(view, active, luminance, tone, of.top);
    const card = useGpu ? gpu?.draw(view, active, tone, of.top) : null;
    if (card) {
      const copy = document.createElement("canvas");
      Object.assign(copy, { width: view.columns, height: view.rows });
      const context = copy.getContext("2d");
      context.drawImage(card, 0, 0);
      bytes = context.getImageData(0, 0, view.columns, view.rows).data;
    }
    return { columns: view.columns, rows: view.rows, sums, bytes, tone, byCard: Boolean(card) };
  },
  async monitor(text) {
    const of = stateOfText(text), light = lightOf(await viewOf(of.camera), of);
    const found = monitorOf(light, of, { off: null, frozen: 0, live: 0 }[of.noise]);
    const { screen, exposure, white } = found;
    return {
      columns: screen.columns, rows: screen.rows, planes: screen.planes, exposure, white, bytes: screenBytes(found, null),
    };
  },
  async targets(text) {
    const of = stateOfText(text);
    return targetFigures(lightOf(await viewOf(of.camera), of), of);
  },
  async reasons(text) {
    const of = stateOfText(text), light = lightOf(await viewOf(of.camera), of);
    return targetFigures(light, of).map((found) => {
      const steps = reasonSteps(light, of, light.view.targets.find(({ name }) => name === found.name), found);
      for (;;) {
        const { done, value } = steps.next();
        if (done) return [found.name, value];
      }
    });
  },
  words: (text) => {
    const of = stateOfText(text);
    return { lamps: lampsTable(of), study: studyText(of), command: commandText(of), text: textOfState(of) };
  },
};

begin();
