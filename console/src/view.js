// SPDX-License-Identifier: Apache-2.0
// The page of `earthshine view`: one layer at a time with an exposure, or in false colours with a scale.
const shown = { layer: null, planes: null, luminance: null, base: 1, top: 0 };

const luminanceOfPlanes = ([r, g, b]) => {
  if (!g) return r;
  const y = new Float32Array(r.length);
  for (let i = 0; i < y.length; ++i) y[i] = 0.2126 * r[i] + 0.7152 * g[i] + 0.0722 * b[i];
  return y;
};

const planesOf = async (layer) => {
  const count = data.columns * data.rows;
  const planes = layer.channels.map(() => new Float32Array(count));
  const halves = await unpackLayer(layer, data.columns, data.rows);
  if (halves) {
    const scale = 2 ** layer.exponent;
    planes.forEach((plane, c) => {
      for (let i = 0; i < count; ++i) plane[i] = halfValue[halves[3 * i + c]] * scale;
    });
  }
  const none = await unpackRuns(layer.none); // infinite, or not a number
  for (const plane of planes) for (const i of none) plane[i] = NaN;
  return planes;
};

const draw = () => {
  const canvas = byId("picture"), power = Number(byId("white").value), isFalse = byId("false").checked;
  const bytes = pictureBytes(shown.planes, shown.luminance, isFalse ? { top: shown.top + power } : { white: shown.base * 10 ** power });
  canvas.width = data.columns;
  canvas.height = data.rows;
  canvas.getContext("2d").putImageData(new ImageData(bytes, data.columns, data.rows), 0, 0);
  byId("stops").value = `${(shown.base * 10 ** power).toPrecision(3)} ${shown.layer.unit}`;
  byId("scale").hidden = !isFalse;
  showScale(shown.top + power, shown.layer.unit);
};

const choose = async () => {
  shown.layer = data.layers[byId("layer").selectedIndex];
  shown.planes = await planesOf(shown.layer);
  shown.luminance = luminanceOfPlanes(shown.planes);
  const lit = litOf(shown.luminance);
  shown.base = lit.length === 0 ? 1 : valueOfRank(lit, Math.round(0.995 * (lit.length - 1)));
  shown.top = falseTopOf(shown.luminance);
  draw();
  document.body.dataset.ready = shown.layer.name;
};

const read = (x, y) => {
  if (x < 0 || y < 0 || x >= data.columns || y >= data.rows || !shown.planes) return;
  const values = shown.planes.map((plane) => plane[y * data.columns + x]);
  const text = values.map((value) => (Number.isNaN(value) ? "none" : value.toPrecision(4))).join("  ");
  const names = shown.layer.names, name = names.length > 0 ? names[Math.round(values[0])] : undefined;
  byId("value").textContent = name ?? `${text} ${shown.layer.unit}`;
  byId("place").textContent = `column ${x + data.x}, row ${y + data.y}` +
    (values.length === 3 ? `; luminance ${shown.luminance[y * data.columns + x].toPrecision(4)} ${shown.layer.unit}` : "");
};

const cursor = { x: 0, y: 0 };
byId("picture").addEventListener("pointermove", (event) => {
  const box = event.target.getBoundingClientRect();
  cursor.x = Math.floor(((event.clientX - box.left) / box.width) * data.columns);
  cursor.y = Math.floor(((event.clientY - box.top) / box.height) * data.rows);
  read(cursor.x, cursor.y);
});
byId("picture").addEventListener("keydown", (event) => {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!step) return;
  event.preventDefault();
  cursor.x = Math.max(0, Math.min(data.columns - 1, cursor.x + step[0]));
  cursor.y = Math.max(0, Math.min(data.rows - 1, cursor.y + step[1]));
  read(cursor.x, cursor.y);
});
showFile();
byId("layer").addEventListener("change", choose);
byId("false").addEventListener("change", draw);
byId("white").addEventListener("input", draw);
choose().catch(showProblem);
