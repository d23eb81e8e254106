// SPDX-License-Identifier: Apache-2.0
// The CCTV chain as degrade/stages.cpp, in its order, of a scene that stands still. docs/console.md says by how much
// it differs from the program.
const decibel = (db) => 10 ** (db / 20);

const pictureGrid = (columns, rows, monitor) => {
  const aspect = columns / rows, rounded = (x, most) => Math.max(1, Math.min(most, Math.round(x)));
  return aspect * monitor.rows <= monitor.columns
    ? { columns: rounded(aspect * monitor.rows, monitor.columns), rows: monitor.rows }
    : { columns: monitor.columns, rows: rounded(monitor.columns / aspect, monitor.rows) };
};

const luminancePlane = ({ planes }) => {
  if (planes.length === 1) return planes[0];
  const y = new Float32Array(planes[0].length);
  for (let i = 0; i < y.length; ++i) y[i] = luminanceOf([planes[0][i], planes[1][i], planes[2][i]]);
  return y;
};

const eachPoint = (picture, f) => ({
  ...picture,
  planes: picture.planes.map((plane) => {
    const out = new Float32Array(plane.length);
    for (let i = 0; i < out.length; ++i) out[i] = f(plane[i]);
    return out;
  }),
});

// f(value, u^2 + v^2), u and v off the centre in half heights.
const eachRadial = (picture, factor) => {
  const { columns, rows } = picture, half = rows / 2, times = new Float64Array(columns * rows);
  for (let y = 0, i = 0; y < rows; ++y) {
    const v = (y + 0.5 - half) / half;
    for (let x = 0; x < columns; ++x, ++i) {
      const u = (x + 0.5 - columns / 2) / half;
      times[i] = factor(u * u + v * v);
    }
  }
  return { ...picture, planes: picture.planes.map((plane) => plane.map((value, i) => value * times[i])) };
};

const powerMean = ({ columns, rows }, y, p, centre) => {
  let largest = 0;
  for (const value of y) if (value > largest) largest = value;
  if (largest === 0) return 0;
  const bell = (i, n) => 1 - ((2 * i + 1) / n - 1) ** 2;
  const along = Array.from({ length: columns }, (_, x) => bell(x, columns));
  let sum = 0, weights = 0;
  for (let row = 0, i = 0; row < rows; ++row) {
    const across = bell(row, rows);
    for (let x = 0; x < columns; ++x, ++i) {
      const weight = 1 - centre * (1 - along[x] * across), value = Math.max(0, y[i]) / largest;
      sum += weight * (p === 4 ? value * value * value * value : value);
      weights += weight;
    }
  }
  return largest * (sum / weights) ** (1 / p);
};

const meteredLuminance = (picture, camera) => {
  if (camera.iris === "fixed") return 0;
  const y = luminancePlane(picture);
  if (camera.iris === "peak") return valueOfRank(y, Math.round(0.995 * (y.length - 1)));
  return camera.iris === "normal" ? powerMean(picture, y, 4, camera.iris_centre) : powerMean(picture, y, 1, 0);
};

const lensTransfer = (camera, fNumber) =>
  (Math.PI * camera.transmittance) / (4 * (fNumber * (1 + camera.magnification)) ** 2);

const irisTarget = { peak: 1, normal: 0.5, average: 0.25 };
const exposureOf = (camera, metered) => {
  if (camera.iris === "fixed") return { fNumber: camera.f_number, gain: decibel(camera.gain_db), metered };
  const wanted = (camera.iris_target || irisTarget[camera.iris]) * camera.white_lux;
  const ideal = Math.sqrt((lensTransfer(camera, 1) * metered) / wanted);
  const fNumber = Math.min(Math.max(ideal, camera.f_number_min), camera.f_number_max);
  const reached = lensTransfer(camera, fNumber) * metered;
  const tooDark = reached < wanted * (1 - 1e-9);
  const gain = tooDark ? Math.min(wanted / reached, decibel(camera.gain_max_db)) : 1;
  return {
    fNumber, gain, metered, underexposed: reached * gain < wanted * (1 - 1e-9), blown: reached > wanted * (1 + 1e-9),
  };
};

const addGlare = (picture, glare) => ({
  ...picture,
  planes: picture.planes.map((plane) => {
    let sum = 0;
    for (const value of plane) sum += value;
    const veil = (glare * sum) / plane.length;
    return plane.map((value) => (1 - glare) * value + veil);
  }),
});

const smearColumns = (picture, share) => ({
  ...picture,
  planes: picture.planes.map((plane) => {
    const { columns, rows } = picture, sum = new Float64Array(columns);
    for (let i = 0; i < plane.length; ++i) sum[i % columns] += plane[i];
    return plane.map((value, i) => value + (10 * share * sum[i % columns]) / rows);
  }),
});

const bloomOver = (picture, { saturation: most, bloom, bloom_radius: radius }) => {
  if (!picture.planes.some((plane) => plane.some((s) => s > most))) return picture;
  const excess = applyMaps(eachPoint(picture, (s) => bloom * Math.max(s - most, 0)),
    gaussianBlur(picture.columns, radius), gaussianBlur(picture.rows, radius));
  return {
    ...picture,
    planes: picture.planes.map((plane, p) => plane.map((s, i) => Math.min(s, most) + excess.planes[p][i])),
  };
};

// The lens: from luminance to signal, the same for both fields.
const throughLens = (light, camera, fovDeg) => {
  let p = light;
  const exposure = exposureOf(camera, meteredLuminance(p, camera)), factor = lensTransfer(camera, exposure.fNumber);
  p = eachPoint(p, (l) => l * factor);
  if (camera.fall_off > 0) {
    const tan = Math.tan((fovDeg * Math.PI) / 360);
    p = eachRadial(p, (r2) => (1 + r2 * tan * tan) ** (-camera.fall_off / 2));
  }
  if (camera.glare > 0) p = addGlare(p, camera.glare);
  const { lens_blur: lensBlur } = camera;
  if (lensBlur > 0) p = applyMaps(p, gaussianBlur(p.columns, lensBlur), gaussianBlur(p.rows, lensBlur));
  p = eachPoint(p, (e) => e / camera.white_lux);
  if (camera.shading_percent > 0) {
    const corner2 = 1 + (p.columns / p.rows) ** 2;
    p = eachRadial(p, (r2) => 1 - ((camera.shading_percent / 100) * r2) / corner2);
  }
  return { signal: p, exposure };
};

// Sensor and electronics of a field, up to the amplified signal. key: of its noise; null for none. before: what lag
// has kept of the field before. Also returns the signal before bloom and saturation (full), and before black clamp and
// gain (before).
const throughSensor = (signal, camera, monitor, law, exposure, key, before) => {
  let p = signal, kept = null;
  if (key !== null) {
    p = addSignalNoise(p, law, key);
    const lag = camera.interlace ? camera.lag : camera.lag ** 2;
    if (lag > 0) {
      const shrink = Math.sqrt((1 - lag) / (1 + lag));
      const settled = before ??
        { ...p, planes: addSignalNoise(signal, law, key + 500).planes.map((plane, k) =>
          plane.map((noisy, i) => signal.planes[k][i] + shrink * (noisy - signal.planes[k][i]))) };
      p = { ...p, planes: p.planes.map((plane, k) => plane.map((now, i) => (1 - lag) * now + lag * settled.planes[k][i])) };
      kept = p;
    }
  }
  if (camera.blur_h > 0 || camera.blur_v > 0) {
    p = applyMaps(p, gaussianBlur(p.columns, camera.blur_h), gaussianBlur(p.rows, camera.blur_v));
  }
  if (camera.smear_db > 0) p = smearColumns(p, 10 ** (-camera.smear_db / 20));
  const full = p;
  if (camera.saturation > 0 && camera.bloom > 0) p = bloomOver(p, camera);
  if (camera.saturation > 0) p = eachPoint(p, (s) => Math.min(s, camera.saturation));
  if (key !== null) p = addReadNoise(p, law, key + 1000);
  if (camera.bandwidth_mhz > 0 || camera.aperture_correction > 0) {
    const line = lineFilter(p.columns, camera.bandwidth_mhz, camera.aperture_correction, monitor.columns);
    p = applyMaps(p, line, gaussianBlur(p.rows, 0));
  }
  const least = camera.black_clamp ? 0 : -Infinity, { gain } = exposure;
  return { amplified: eachPoint(p, (s) => gain * Math.max(s, least)), kept, full, before: p };
};

const toLine = (amplified, camera) => {
  const clip = camera.white_clip > 0 ? camera.white_clip : Infinity, power = 1 / camera.gamma;
  const levels = camera.bits > 0 ? 2 ** camera.bits - 1 : 0;
  return eachPoint(amplified, (s) => {
    let v = Math.min(s, clip);
    if (camera.gamma !== 1) v = v > 0 ? v ** power : 0;
    return levels ? Math.round(Math.min(Math.max(v, 0), 1) * levels) / levels : v;
  });
};

const weave = (first, second) => ({
  ...first,
  planes: first.planes.map((plane, p) =>
    plane.map((value, i) => (((i / first.columns) | 0) % 2 ? second.planes[p][i] : value))),
});

const measureLevels = (amplified, blackNoise) => {
  const y = luminancePlane(amplified);
  let saturated = 0, crushed = 0;
  for (const value of y) {
    if (value >= 0.995) ++saturated;
    if (value <= blackNoise) ++crushed;
  }
  return { saturated: saturated / y.length, crushed: crushed / y.length };
};

// light: {columns, rows, planes} in cd/m^2 on the sensor's grid. frame: number of the noise; null for none.
const runChain = (light, { camera, monitor }, fovDeg, frame) => {
  const { signal, exposure } = throughLens(light, camera, fovDeg);
  const law = noiseLaw(camera), key = frame === null ? null : 10 * frame + 100;
  const fieldOf = (number, before) =>
    throughSensor(signal, camera, monitor, law, exposure, key === null ? null : key + number, before);
  const first = fieldOf(0, null);
  const second = camera.interlace && key !== null ? fieldOf(1, first.kept) : null;
  let line = toLine(first.amplified, camera);
  if (second) line = weave(line, toLine(second.amplified, camera));
  const { black_luminance: black, white_luminance: white, gamma } = monitor;
  let screen = eachPoint(line, (v) => black + (white - black) * Math.min(Math.max(v, 0), 1) ** gamma);
  if (monitor.spread !== "none" || monitor.pixels_per_resel > 1) {
    const map = (resels) => spreadMap(monitor.spread, monitor.spread_width, resels, monitor.pixels_per_resel);
    screen = applyMaps(screen, map(screen.columns), map(screen.rows));
    if (monitor.spread === "sinc") screen = eachPoint(screen, (value) => Math.max(value, 0));
  }
  const room = (monitor.reflectance * monitor.room_illuminance) / Math.PI;
  if (room > 0) for (const plane of screen.planes) for (let i = 0; i < plane.length; ++i) plane[i] += room;
  return {
    screen, white: white + room, exposure, law, signal: first.amplified,
    levels: measureLevels(first.amplified, exposure.gain * Math.sqrt(atBlack(law))),
  };
};
