// SPDX-License-Identifier: Apache-2.0
// A camera's layers in memory, and weighted sums of them in 32-bit floats.
const luminanceShare = [0.2126, 0.7152, 0.0722]; // Rec. 709, as base::luminance

// The value of each of the 65536 half floats.
const halfValue = (() => {
  const values = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const power = (bits >> 10) & 31, steps = bits & 1023;
    const size = power === 0 ? steps * 2 ** -24 : (1024 + steps) * 2 ** (power - 25);
    values[bits] = bits & 0x8000 ? -size : size;
  }
  return values;
})();

const loadView = async (camera) => {
  const { columns, rows } = camera;
  const view = { camera, columns, rows, count: columns * rows, layers: [] };
  for (const layer of camera.layers) {
    const halves = await unpackLayer(layer, columns, rows);
    if (halves) {
      view.layers.push({ light: layer.light, place: layer.place, scale: 2 ** layer.exponent, halves, planes: {} });
    }
  }
  view.objects = await unpackObjects(camera.objects);
  view.targets = [];
  for (const target of camera.targets) {
    const seen = [], parts = [];
    view.objects.forEach((object, i) => { if (object === target.object + 1) seen.push(i); });
    for (const part of target.parts) {
      parts.push({ ...part, target: await unpackRuns(part.target), surround: await unpackRuns(part.surround) });
    }
    view.targets.push({
      ...target, seen, parts, measured: await unpackRuns(target.measured), surround: await unpackRuns(target.surround),
    });
  }
  return view;
};

// Planes of a layer are made when they are first asked for: 0, 1, 2 for R, G, B, "y" for luminance; with a grid
// ("300x300"), averaged onto the resels of a sensor.
const planeOf = (view, layer, name, grid) => {
  const key = grid ? `${name} ${grid.columns}x${grid.rows}` : name;
  if (layer.planes[key]) return layer.planes[key];
  let plane;
  if (grid) {
    const whole = { columns: view.columns, rows: view.rows, planes: [planeOf(view, layer, name)] };
    plane = applyMaps(whole, areaAverage(view.columns, grid.columns), areaAverage(view.rows, grid.rows)).planes[0];
    if (name !== "y") delete layer.planes[name];
  } else {
    const { halves, scale } = layer;
    plane = new Float32Array(view.count);
    for (let i = 0; i < view.count; ++i) {
      plane[i] = scale * (name === "y"
        ? luminanceShare[0] * halfValue[halves[3 * i]] + luminanceShare[1] * halfValue[halves[3 * i + 1]] +
          luminanceShare[2] * halfValue[halves[3 * i + 2]]
        : halfValue[halves[3 * i + name]]);
    }
  }
  layer.planes[key] = plane;
  return plane;
};

// [layer, R, G, B] of all layers that shine at this place of the orbit.
const activeLayers = (view, factors, place) =>
  view.layers
    .filter((layer) => layer.place === null || layer.place === place)
    .map((layer) => [layer, factors[layer.light]])
    .filter(([, factor]) => factor.some((value) => value !== 0));

const isGrey = ([r, g, b]) => r === g && g === b;

const addTimes = (sum, plane, factor) => {
  for (let i = 0; i < sum.length; ++i) sum[i] += factor * plane[i];
};

// Luminance of the weighted sum, of the picture or of a sensor's grid.
const sumLuminance = (view, active, grid) => {
  const sum = new Float32Array(grid ? grid.columns * grid.rows : view.count);
  for (const [layer, factor] of active) {
    if (isGrey(factor)) {
      addTimes(sum, planeOf(view, layer, "y", grid), factor[0]);
    } else {
      for (const c of [0, 1, 2]) addTimes(sum, planeOf(view, layer, c, grid), factor[c] * luminanceShare[c]);
    }
  }
  return sum;
};

const sumColour = (view, active, colour, grid) => {
  const sum = new Float32Array(grid ? grid.columns * grid.rows : view.count);
  for (const [layer, factor] of active) addTimes(sum, planeOf(view, layer, colour, grid), factor[colour]);
  return sum;
};

// R, G, B at one pixel, in all and by light: [[light, [R, G, B]], ...].
const lightAt = (view, active, pixel) => {
  const byLight = new Map(), whole = [0, 0, 0];
  for (const [layer, factor] of active) {
    const rgb = [0, 1, 2].map((c) => factor[c] * layer.scale * halfValue[layer.halves[3 * pixel + c]]);
    const before = byLight.get(layer.light) ?? [0, 0, 0];
    byLight.set(layer.light, before.map((value, c) => value + rgb[c]));
    rgb.forEach((value, c) => { whole[c] += value; });
  }
  return { whole, byLight: [...byLight] };
};

const luminanceOf = ([r, g, b]) => luminanceShare[0] * r + luminanceShare[1] * g + luminanceShare[2] * b;

const meanOver = (plane, pixels) => {
  let sum = 0;
  for (const pixel of pixels) sum += plane[pixel];
  return sum / pixels.length;
};
