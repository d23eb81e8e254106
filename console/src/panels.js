// SPDX-License-Identifier: Apache-2.0
// Choices, the camera's settings, targets, the orbit, the reading under the pointer, the copies.

// One of a few; arrow keys go from one to the next.
const makeChoice = (box, options, chosen, choose) => {
  box.replaceChildren(...options.map(([value, text, title]) => {
    const button = make("button", { textContent: text, role: "radio", title: title ?? text, data: { value } });
    button.addEventListener("click", () => choose(value));
    return button;
  }));
  box.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const at = options.findIndex(([value]) => value === chosen());
    choose(options[(at + step + options.length) % options.length][0]);
    box.querySelector("[aria-checked=true]").focus();
  });
  return () => {
    for (const button of box.children) {
      const on = button.dataset.value === String(chosen());
      button.setAttribute("aria-checked", String(on));
      button.tabIndex = on ? 0 : -1;
    }
  };
};

const setSetting = ({ of, part, name }, value) =>
  changeState((to) => {
    const base = data.presets.find((preset) => preset.name === to.model) ?? data.cameras[to.camera].cctv;
    if (base[part][name] === value) delete to[of][name];
    else to[of][name] = value;
  });

const makePanel = (box) => {
  const rows = [];
  const row = (label, input, unit) => {
    const element = make("label", {}, make("span", { textContent: label }), input, make("em", { textContent: unit ?? "" }));
    box.append(element);
    return element;
  };
  const model = make("select", {}, make("option", { value: "", textContent: "as in the scene" }),
    ...data.presets.map(({ name }) => make("option", { value: name, textContent: name })));
  model.addEventListener("change", () =>
    changeState((to) => Object.assign(to, { model: model.value, camera_set: {}, monitor_set: {} })));
  row("Model", model);
  for (const control of settingControls) {
    const input = control.words
      ? make("select", {}, ...control.words.map((word) => make("option", { value: word, textContent: word })))
      : make("input", { type: "number", min: control.low, max: control.high, step: "any" });
    input.addEventListener("change", () => {
      const value = control.words ? input.value : Number(input.value);
      if (control.words || (input.value !== "" && value >= control.low && value <= control.high)) setSetting(control, value);
      else stateChanged();
    });
    rows.push({ control, input, element: row(control.label, input, control.unit) });
  }
  const noise = make("select", {}, ...["off", "frozen", "live"].map((word) => make("option", { value: word, textContent: word })));
  noise.addEventListener("change", () => changeState((to) => { to.noise = noise.value; }));
  row("Noise", noise);
  const white = make("input", { type: "number", min: 1e-9, step: "any", title: "empty: the picture’s own" });
  white.addEventListener("change", () =>
    changeState((to) => { to.white = white.value !== "" && white.value > 0 ? Number(white.value) : null; }));
  row("Clean white", white, "cd/m²");
  return () => {
    const now = modelOf(state);
    model.value = state.model;
    model.firstChild.textContent = data.cameras[state.camera].cctv.name;
    noise.value = state.noise;
    if (document.activeElement !== white) white.value = state.white === null ? "" : short(state.white, 4);
    for (const { control, input, element } of rows) {
      const value = now[control.part][control.name];
      element.hidden = Boolean(control.when && !control.when(now.camera));
      if (document.activeElement !== input || control.words) input.value = control.words ? value : short(value, 4);
      element.classList.toggle("changed", control.name in state[control.of]);
    }
  };
};

const showMeter = (box, { monitor, tone }) => {
  if (monitor) {
    const { exposure, levels } = monitor;
    const words = [`f/${short(exposure.fNumber, 3)}`, `gain ${short(20 * Math.log10(exposure.gain), 3)} dB`,
      `${short(100 * levels.saturated, 2)} % at white`, `${short(100 * levels.crushed, 2)} % lost in black`];
    if (exposure.underexposed) words.push("too dark, wide open");
    if (exposure.blown) words.push("too bright, closed");
    box.textContent = words.join(" · ");
  } else {
    box.textContent = `${tone.kind === "own" ? "Own exposure" : "Fixed exposure"} · white at ${luminanceText(tone.white / tone.exposure)}`;
  }
};

const signed = (value) => (value === undefined ? "–" : `${value < 0 ? "−" : "+"}${short(Math.abs(value) * 100, 2)} %`);
const figuresText = ({ chances: p, snrD, onMonitor, threshold, lines, cycles }) => {
  const words = [];
  if (p) words.push(`probability ${p.map((value, k) => `${tasks[k]} ${value.toFixed(2)}`).join(", ")}`);
  if (onMonitor !== undefined) words.push(`contrast on the monitor ${signed(onMonitor)}`);
  if (threshold !== undefined) words.push(`least contrast that the eye sees ${signed(threshold).slice(1)}`);
  if (snrD !== undefined) words.push(`SNR of the whole target in 0.2 s ${short(snrD, 2)}`);
  if (lines !== undefined) words.push(`${short(lines, 2)} TV lines across it`);
  if (cycles !== undefined) words.push(`${short(cycles, 2)} cycles resolved`);
  return words.join("; ");
};
// reasons: words by target's name; none yet: empty.
const showTargets = (box, figures, reasons) => {
  if (figures.length === 0) {
    box.textContent = "The scene marks no targets.";
    return;
  }
  const head = make("tr", {}, ...["Target", "cd/m²", "Contrast", "SNR", "Verdict"].map((text) => make("th", { scope: "col", textContent: text })));
  const rows = figures.flatMap((found) => {
    const { name, luminance, weber, snr, verdict } = found, why = reasons.get(name);
    const bar = make("i", { className: "contrast" });
    bar.style.setProperty("--of", Math.max(-1, Math.min(1, weber ?? 0)));
    const row = make("tr", { data: { verdict }, title: figuresText(found) }, make("th", { scope: "row", textContent: name }),
      make("td", { textContent: luminance === undefined ? "–" : short(luminance, 2) }),
      make("td", {}, bar, signed(weber)),
      make("td", { textContent: snr === undefined ? "–" : short(snr, 2) }),
      make("td", {}, make("b", { textContent: verdict })));
    return why ? [row, make("tr", { className: "why" }, make("td", { colSpan: 5, textContent: why }))] : [row];
  });
  box.replaceChildren(make("table", {}, make("thead", {}, head), make("tbody", {}, ...rows)));
};

// The pixel's light by source: words and a bar.
const showReading = (box, light, place) => {
  if (!place) {
    box.replaceChildren(make("span", { className: "hint", textContent: "Point at the picture to read a pixel's light by source." }));
    return;
  }
  const { view, active } = light, [x, y] = place, pixel = y * view.columns + x;
  const { whole, byLight } = lightAt(view, active, pixel), total = luminanceOf(whole);
  const object = view.objects[pixel] > 0 ? data.objects[view.objects[pixel] - 1] : "nothing";
  const sources = byLight.map(([k, rgb]) => [data.lights[k].name, luminanceOf(rgb)]).sort((a, b) => b[1] - a[1]);
  const shown = sources.filter(([, y]) => y > 0.005 * total).slice(0, 6);
  const bar = make("div", { className: "sources" }, ...shown.map(([name, y], k) => {
    const part = make("i", { className: `s${k}`, title: name });
    part.style.width = `${(100 * y) / total}%`;
    return part;
  }));
  box.replaceChildren(
    make("b", { textContent: luminanceText(total) }), make("span", { textContent: `on ${object} at ${x}, ${y}` }), bar,
    make("span", { className: "list", textContent: total > 0 ? shown.map(([name, y]) => `${name} ${Math.round((100 * y) / total)} %`).join(" · ") : "no light" }));
};

const phaseOf = (place) => place.phase || "–";
const placeText = ({ utc, position_deg: position, time_s: time, phase }) =>
  [utc || (position === null ? "" : `${short(position, 4)}°`), time === null || utc ? "" : `${Math.round(time / 60)} min from noon`, phase]
    .filter(Boolean).join(" · ");
const isSeen = (verdict) => ["identified", "recognised", "detected"].includes(verdict);
const makeOrbit = (box) => {
  if (data.places.length < 2) return () => {};
  box.hidden = false;
  const slider = make("input", { type: "range", min: 0, max: data.places.length - 1, step: 1, "aria-label": "Place along the orbit" });
  slider.addEventListener("input", () => changeState((to) => { to.place = Number(slider.value); }, "orbit"));
  slider.addEventListener("change", endMove);
  const band = make("div", { className: "band" }, ...data.places.map((place) => make("i", { className: phaseOf(place) })));
  // Of a study: the share of the targets in view that the camera's viewer sees at each stop.
  const seen = make("div", { className: "band seen" }, ...data.places.map(() => make("i")));
  const words = make("span");
  box.append(make("div", { className: "track" }, band, seen, slider), words);
  return () => {
    slider.value = state.place;
    words.textContent = placeText(data.places[state.place]);
    slider.setAttribute("aria-valuetext", words.textContent);
    const setting = settingOf(state);
    seen.hidden = setting < 0;
    if (seen.hidden) return;
    data.places.forEach((place, k) => {
      const judged = judgedByStudy(state.camera, setting, k).map(([, found]) => found?.[0]).filter((verdict) => verdict && verdict !== "out-of-view");
      const count = judged.filter(isSeen).length;
      seen.children[k].style.setProperty("--share", judged.length ? count / judged.length : 0);
      seen.children[k].title = `${placeText(place)}: ${count} of ${judged.length} targets seen`;
    });
  };
};

const makeSettings = (select) => {
  if (!data.study) return () => {};
  select.hidden = false;
  const other = make("option", { value: -1, textContent: "as on the faders", disabled: true });
  select.append(...data.study.settings.map(({ name }, k) => make("option", { value: k, textContent: name })), other);
  select.addEventListener("change", () => changeState((to) => Object.assign(to, withSetting(to, Number(select.value)))));
  return () => { select.value = settingOf(state); };
};

const showScale = (box, top) => {
  box.hidden = top === null;
  if (top === null) return;
  const colours = falseAnchors.map((hex) => `#${hex}`).join(", ");
  const ramp = make("div", { className: "ramp" });
  ramp.style.background = `linear-gradient(to top, ${colours})`;
  const marks = Array.from({ length: falseDecades + 1 }, (_, k) =>
    make("span", { textContent: short(10 ** (top - k), 1) }));
  box.replaceChildren(ramp, make("div", { className: "marks" }, ...marks), make("em", { textContent: "cd/m²" }));
};

const showCopies = () => {
  const link = `${location.href.split("#")[0]}#${textOfState(state)}`;
  const block = (title, text) => {
    const area = make("textarea", { readOnly: true, rows: Math.min(12, text.split("\n").length + 1), value: text, spellcheck: false, "aria-label": title });
    const button = make("button", { textContent: "Copy" });
    button.addEventListener("click", async () => {
      area.select();
      // Pages from a file may not write to the clipboard by promise.
      const done = document.execCommand("copy");
      button.textContent = done ? "Copied" : "Press Ctrl+C";
    });
    return make("section", {}, make("h3", { textContent: title }), button, area);
  };
  byId("copied").replaceChildren(block("Link", link), block("Lamps of a study file", lampsTable(state)), block("Command", commandText(state)));
  byId("copies").showModal();
};
