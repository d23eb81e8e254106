// SPDX-License-Identifier: Apache-2.0
// The desk: a strip with a fader for each light, and for each group of lamps a master.
const make = (tag, properties = {}, ...children) => {
  const { data: dataset, ...plain } = properties;
  const element = Object.assign(document.createElement(tag), plain);
  for (const [name, value] of Object.entries(dataset ?? {})) element.dataset[name] = value;
  for (const name of Object.keys(plain)) if (name.includes("-") || name === "role") element.setAttribute(name, plain[name]);
  element.append(...children);
  return element;
};
const byId = (id) => document.getElementById(id);

// What one strip works on: where its level stands in the state.
const stripsOf = () => {
  const groups = [...new Set(data.lights.map(({ group }) => group).filter(Boolean))];
  const members = (group) => data.lights.filter((light) => light.group === group).length;
  const strips = [];
  for (const group of groups) if (members(group) > 1) strips.push({ name: group, in: "group", kind: "master" });
  for (const { name, kind, group } of data.lights) if (kind !== "ambient") strips.push({ name, in: "level", kind, group });
  const order = { sun: 0, earth: 1, master: 2 };
  return strips.sort((a, b) => (order[a.kind] ?? 3) - (order[b.kind] ?? 3));
};

// "bay-3-mid-starboard" under its master "bay-lamps" stays as it is; long names wrap at their hyphens.
const stripName = (name) => name.replaceAll(/[-_]/g, (mark) => `${mark}\u200b`);

const makeStrip = (strip) => {
  const set = (value, whileMoving) =>
    changeState((to) => {
      if (value === 1) delete to[strip.in][strip.name];
      else to[strip.in][strip.name] = value;
    }, whileMoving);
  const isMaster = strip.in === "group";
  const fader = make("input", { type: "range", className: "fader", min: 0, max: 1000, step: 1, "aria-label": `${strip.name}, level` });
  const level = make("input", { type: "number", className: "level", min: 0, max: mostLevel, step: "any", "aria-label": `${strip.name}, factor` });
  const meter = make("div", { className: "bar" }, make("i"));
  fader.addEventListener("input", () => set(levelOfWay(Number(fader.value)), strip.name));
  fader.addEventListener("change", endMove);
  fader.addEventListener("dblclick", () => set(1));
  level.addEventListener("change", () => {
    const value = Number(level.value);
    if (level.value !== "" && value >= 0 && value <= mostLevel) set(value);
    else stateChanged();
  });
  const parts = [make("div", { className: "way" }, fader, meter), level];
  let tint = null, off = null;
  if (!isMaster) {
    tint = make("input", { type: "color", className: "tint", value: "#ffffff", "aria-label": `${strip.name}, colour` });
    tint.addEventListener("input", () =>
      changeState((to) => {
        if (tint.value === "#ffffff") delete to.tint[strip.name];
        else to.tint[strip.name] = tint.value;
      }, `tint ${strip.name}`));
    tint.addEventListener("change", endMove);
    off = make("button", { className: "off", textContent: "on", "aria-label": `${strip.name}, switch`, title: "Switch (o)" });
    off.addEventListener("click", () =>
      changeState((to) => {
        if (to.off[strip.name]) delete to.off[strip.name];
        else to.off[strip.name] = true;
      }));
    parts.push(make("div", { className: "row" }, off, tint));
  } else {
    parts.push(make("div", { className: "row" }, make("span", { className: "mark", textContent: "master" })));
  }
  const element = make("div", { className: `strip ${strip.kind}`, role: "group", "aria-label": strip.name },
    ...parts, make("div", { className: "name", title: strip.name, textContent: stripName(strip.name) }));
  const light = data.lights.findIndex(({ name }) => name === strip.name);

  // shares: of each light in the mean luminance of the picture.
  const show = (shares) => {
    const value = state[strip.in][strip.name] ?? 1, isOff = Boolean(state.off[strip.name]);
    fader.value = wayOfLevel(value);
    fader.setAttribute("aria-valuetext", `${short(value, 3)} times`);
    if (document.activeElement !== level) level.value = short(value, 3);
    element.classList.toggle("is-off", isOff || value === 0);
    if (off) {
      off.textContent = isOff ? "off" : "on";
      off.setAttribute("aria-pressed", String(!isOff));
      tint.value = state.tint[strip.name] ?? "#ffffff";
    }
    const share = isMaster
      ? data.lights.reduce((sum, one, k) => sum + (one.group === strip.name ? shares[k] : 0), 0)
      : shares[light];
    meter.firstChild.style.height = `${Math.round(100 * Math.sqrt(Math.max(0, share)))}%`;
    meter.title = `${short(100 * share, 2)} % of the picture's light`;
  };
  return { element, show };
};

// Of each light in the mean luminance of what the camera sees.
const meansKnown = new WeakMap();
const meanOfLayer = (view, layer, c) => {
  const means = meansKnown.get(layer) ?? [0, 1, 2].map((colour) => {
    let sum = 0;
    for (let i = 0; i < view.count; ++i) sum += halfValue[layer.halves[3 * i + colour]];
    return (layer.scale * sum) / view.count;
  });
  meansKnown.set(layer, means);
  return means[c];
};
const sharesOf = ({ view, active }) => {
  const means = data.lights.map(() => 0);
  for (const [layer, factor] of active) {
    means[layer.light] += luminanceOf(factor.map((value, c) => value * meanOfLayer(view, layer, c)));
  }
  const total = means.reduce((sum, value) => sum + value, 0);
  return { total, shares: means.map((value) => (total > 0 ? value / total : 0)) };
};
