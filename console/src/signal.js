// SPDX-License-Identifier: Apache-2.0
// The noise-free signal of a CCTV camera, the variances of its noise where they enter, and the filters and point maps
// after them, as studies/sight/cctv_signal.cpp; means over sets of resels and their noise, as weighted_resels.cpp.
const leastNoiseTap = 1e-5;

const middleSquares = ({ start, weight, out }) => {
  const middle = out >> 1;
  let sum = 0;
  for (let k = start[middle]; k < start[middle + 1]; ++k) sum += weight[k] * weight[k];
  return sum;
};

const meanSpread = known(function meanSpread(spread, width, resels, pixels) {
  if (spread === "none" && pixels === 1) return gaussianBlur(resels, 0);
  return withoutTapsBelow(chained(spreadMap(spread, width, resels, pixels), areaAverage(resels * pixels, resels)), leastNoiseTap);
});
const farless = known(function farless(kind, ...given) {
  return withoutTapsBelow({ gaussianBlur, lineFilter }[kind](...given), leastNoiseTap);
});

const passThrough = (light, { camera, monitor }, fovDeg) => {
  const { signal: exposed, exposure } = throughLens(light, camera, fovDeg);
  const { before, full } = throughSensor(exposed, camera, monitor, null, exposure, null, null);
  const { columns, rows } = before, law = noiseLaw(camera);
  const steps = [];
  if (camera.black_clamp) steps.push(["below", 0]);
  if (exposure.gain !== 1) steps.push(["amplify", exposure.gain]);
  if (camera.white_clip > 0) steps.push(["above", camera.white_clip]);
  if (camera.gamma !== 1) steps.push(["power", 1 / camera.gamma]);
  if (camera.bits > 0) steps.push(["quantise", 2 ** camera.bits - 1]);
  const { black_luminance: black, white_luminance: white } = monitor;
  const shown = [...steps, ["below", 0], ["above", 1], ["power", monitor.gamma],
    ...(white === black ? [["above", 0]] : [["amplify", white - black]]), ["shift", black]];
  const line = {
    columns, rows, exposure, law, hasFields: camera.interlace, lagPerField: camera.lag, amplifier: law.a,
    amplifierPattern: law.blackPattern, line: pointMap(steps), screen: pointMap(shown),
    share: before.planes.length === 3 ? luminanceShare : [1],
    blurAlong: farless("gaussianBlur", columns, camera.blur_h), blurAcross: farless("gaussianBlur", rows, camera.blur_v),
    bandwidth: farless("lineFilter", columns, camera.bandwidth_mhz, camera.aperture_correction, monitor.columns),
    spreadAlong: meanSpread(monitor.spread, monitor.spread_width, columns, monitor.pixels_per_resel),
    spreadAcross: meanSpread(monitor.spread, monitor.spread_width, rows, monitor.pixels_per_resel),
    room: (monitor.reflectance * monitor.room_illuminance) / Math.PI,
  };
  const read = squaredMap(line.bandwidth);
  line.amplifierAtLine = Float32Array.from({ length: columns }, (_, x) => {
    let sum = 0;
    for (let k = read.start[x]; k < read.start[x + 1]; ++k) sum += read.weight[k];
    return sum;
  });
  const along = squaredMap(chained(line.blurAlong, line.bandwidth)), across = squaredMap(line.blurAcross);
  const lag = camera.interlace ? camera.lag : camera.lag ** 2, lagFactor = (1 - lag) / (1 + lag);
  const c = law.fixed ? 0 : law.c, filtered = (plane) => applyMaps({ columns, rows, planes: [plane] }, along, across).planes[0];
  line.planes = before.planes.map((signal, p) => {
    const plane = { signal, pattern: null, patternAtLine: null, passed: null };
    plane.grain = exposed.planes[p].map((value) => {
      const s = Math.max(value, 0);
      return lagFactor * (law.dark + (law.b + c * s) * s);
    });
    plane.grainAtLine = filtered(plane.grain);
    if (law.fixed && law.c > 0) {
      plane.pattern = exposed.planes[p].map((value) => law.c * value * value);
      plane.patternAtLine = filtered(plane.pattern);
    }
    if (camera.saturation > 0) {
      const factor = middleSquares(line.blurAlong) * middleSquares(line.blurAcross);
      plane.passed = full.planes[p].map((value, i) => {
        const variance = factor * (plane.grain[i] + (plane.pattern?.[i] ?? 0)), room = camera.saturation - value;
        return room * room < 64 * variance ? normalProbability(room / Math.sqrt(variance)) : room > 0 ? 1 : 0;
      });
      for (const at of [plane.grainAtLine, plane.patternAtLine]) {
        if (at) plane.passed.forEach((share, i) => { at[i] *= share * share; });
      }
    }
    return plane;
  });
  let sum = 0, count = 0;
  const step = Math.max(1, Math.floor((columns * rows) / 4096));
  for (let i = step >> 1; i < columns * rows; i += step, ++count) {
    line.planes.forEach(({ signal }, p) => { sum += line.share[p] * line.screen.at(signal[i]); });
  }
  line.screenLuminance = sum / count + line.room;
  return line;
};

// {resel, weight}: the resels of the grid that these pixels cover; the weights sum to 1.
const weigh = (pixels, view, grid) => {
  const cover = new Map();
  const parts = (pixel, of, onto) => {
    const step = onto / of, begin = pixel * step, end = (pixel + 1) * step, found = [];
    for (let k = Math.floor(begin); k < onto && k < end; ++k) {
      const share = Math.min(end, k + 1) - Math.max(begin, k);
      if (share > 1e-9 * step) found.push([k, share]);
    }
    return found;
  };
  let row = -1, across = [];
  for (const pixel of pixels) {
    const y = Math.floor(pixel / view.columns);
    if (y !== row) across = parts(row = y, view.rows, grid.rows);
    const along = parts(pixel % view.columns, view.columns, grid.columns);
    for (const [j, shareY] of across) {
      for (const [i, shareX] of along) cover.set(j * grid.columns + i, (cover.get(j * grid.columns + i) ?? 0) + shareX * shareY);
    }
  }
  const sorted = [...cover].sort((a, b) => a[0] - b[0]), area = sorted.reduce((sum, [, weight]) => sum + weight, 0);
  return { resel: Uint32Array.from(sorted, ([resel]) => resel), weight: Float64Array.from(sorted, ([, weight]) => weight / area) };
};

const meanOfSet = (values, { resel, weight }) => {
  let sum = 0;
  for (let i = 0; i < resel.length; ++i) sum += weight[i] * values[resel[i]];
  return sum;
};

// Parts of the grid with a value per resel.
const newBox = (x0, y0, columns, rows) => ({ x0, y0, columns, rows, values: new Float64Array(columns * rows) });
const boxAround = (sets, columns) => {
  let [left, right, top, bottom] = [Infinity, -1, Infinity, -1];
  for (const { resel } of sets) {
    for (const at of resel) {
      const x = at % columns, y = Math.floor(at / columns);
      [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
    }
  }
  return newBox(left, top, right - left + 1, bottom - top + 1);
};
const filledBox = (like, { resel, weight }, columns, field, f) => {
  const box = newBox(like.x0, like.y0, like.columns, like.rows);
  for (let i = 0; i < resel.length; ++i) {
    const x = resel[i] % columns, y = Math.floor(resel[i] / columns);
    if (field < 0 || y % 2 === field) box.values[(y - box.y0) * box.columns + x - box.x0] = weight[i] * f(resel[i]);
  }
  return box;
};
const sourcesOf = ({ start, source }, first, count) => {
  let low = Infinity, high = -1;
  for (let k = start[first]; k < start[first + count]; ++k) [low, high] = [Math.min(low, source[k]), Math.max(high, source[k])];
  return [low, high - low + 1];
};
const transposedAlong = (box, map) => {
  const [first, count] = sourcesOf(map, box.x0, box.columns), out = newBox(first, box.y0, count, box.rows);
  const { start, source, weight } = map;
  for (let y = 0; y < box.rows; ++y) {
    for (let x = 0; x < box.columns; ++x) {
      const value = box.values[y * box.columns + x];
      if (value === 0) continue;
      const i = box.x0 + x, to = y * count - first;
      for (let k = start[i]; k < start[i + 1]; ++k) out.values[to + source[k]] += weight[k] * value;
    }
  }
  return out;
};
const transposedAcross = (box, map) => {
  const [first, count] = sourcesOf(map, box.y0, box.rows), out = newBox(box.x0, first, box.columns, count);
  const { start, source, weight } = map;
  for (let y = 0; y < box.rows; ++y) {
    const i = box.y0 + y;
    for (let k = start[i]; k < start[i + 1]; ++k) {
      const to = (source[k] - first) * box.columns, w = weight[k];
      for (let x = 0; x < box.columns; ++x) out.values[to + x] += w * box.values[y * box.columns + x];
    }
  }
  return out;
};

// Resels whose light the phosphor spreads to these.
const screenSources = (line, of) => {
  if (of.resel.length === 0) return of;
  const reach = transposedAcross(transposedAlong(filledBox(boxAround([of], line.columns), of, line.columns, -1, () => 1),
    line.spreadAlong), line.spreadAcross);
  const resel = [], weight = [];
  reach.values.forEach((value, i) => {
    if (value === 0) return;
    resel.push((reach.y0 + Math.floor(i / reach.columns)) * line.columns + reach.x0 + (i % reach.columns));
    weight.push(value);
  });
  return { resel: Uint32Array.from(resel), weight: Float64Array.from(weight) };
};

// For noise of correlation `lag` from field to field: variance of one field's mean over frames, and covariance with
// the other field's mean.
const timeFactors = (lag, hasFields, frames) => {
  let same = 0, other = 0;
  for (let i = 0; i < frames; ++i) {
    for (let j = 0; j < frames; ++j) {
      same += lag ** (2 * Math.abs(i - j));
      if (hasFields) other += lag ** Math.abs(2 * (i - j) + 1);
    }
  }
  return [same / frames ** 2, other / frames ** 2];
};

// Moments at the resels of the line signal and of the screen, the planes combined to luminance.
const momentsAt = (line, resels, screen, frames) => {
  const count = line.columns * line.rows, [lightInTime] = timeFactors(line.lagPerField, line.hasFields, frames);
  const found = { slope: [] };
  for (const name of ["mean", "variance", "varianceInTime", "luminance", "beyond"]) found[name] = new Float32Array(count);
  line.planes.forEach((plane, p) => {
    const share = line.share[p], share2 = share * share, slope = new Float32Array(count);
    const scatter = (resel) => {
      const taps = line.amplifierAtLine[resel % line.columns], grain = plane.grainAtLine[resel];
      const pattern = (plane.patternAtLine?.[resel] ?? 0) + taps * line.amplifierPattern;
      return [Math.fround(grain + taps * line.amplifier + pattern),
        lightInTime * grain + (taps * line.amplifier) / frames + pattern];
    };
    const through = (map, at) => momentsOfAll(map, Float32Array.from(at, (i) => plane.signal[i]), Float32Array.from(at, (i) => scatter(i)[0]));
    const [mean, variance, rise] = through(line.line, resels);
    resels.forEach((resel, i) => {
      const [frame, inTime] = scatter(resel), power = rise[i] * rise[i], beyond = Math.max(0, variance[i] - power * frame);
      found.mean[resel] += share * mean[i];
      found.variance[resel] += share2 * variance[i];
      found.varianceInTime[resel] += share2 * (power * inTime + beyond / frames);
      found.beyond[resel] += share2 * beyond;
      slope[resel] = rise[i];
    });
    const [light] = through(line.screen, screen);
    screen.forEach((resel, i) => { found.luminance[resel] += share * light[i]; });
    found.slope.push(slope);
  });
  return found;
};

// Variances of the means over two sets of resels, and their covariance, over frames.
const meanNoise = (line, moments, a, b, frames) => {
  const noise = { a: 0, b: 0, both: 0 }, place = boxAround([a, b], line.columns), fields = line.hasFields ? [0, 1] : [-1];
  const light = timeFactors(line.lagPerField, line.hasFields, frames), read = timeFactors(0, line.hasFields, frames), still = [1, 1];
  line.planes.forEach((plane, p) => {
    const share = line.share[p] ** 2, slope = moments.slope[p];
    const byAmplifier = fields.map((field) =>
      [a, b].map((set) => transposedAlong(filledBox(place, set, line.columns, field, (resel) => slope[resel]), line.bandwidth)));
    const byLight = byAmplifier.map((pair) => pair.map((box) => {
      let passed = box;
      if (plane.passed) {
        passed = { ...box, values: box.values.map((value, i) =>
          value * plane.passed[(box.y0 + Math.floor(i / box.columns)) * line.columns + box.x0 + (i % box.columns)]) };
      }
      return transposedAcross(transposedAlong(passed, line.blurAlong), line.blurAcross);
    }));
    const add = (seen, variance, time) => {
      seen.forEach((one, f) => seen.forEach((other, h) => {
        const factor = share * time[f === h ? 0 : 1], [{ x0, y0, columns, values: a1 }, { values: b1 }] = one;
        if (factor === 0) return;
        const a2 = other[0].values, b2 = other[1].values;
        for (let i = 0, x = 0, y = 0; i < a1.length; ++i) {
          const v = factor * (typeof variance === "number" ? variance : variance[(y0 + y) * line.columns + x0 + x]);
          noise.a += v * a1[i] * a2[i];
          noise.b += v * b1[i] * b2[i];
          noise.both += v * a1[i] * b2[i];
          if (++x === columns) [x, y] = [0, y + 1];
        }
      }));
    };
    add(byLight, plane.grain, light);
    if (plane.pattern) add(byLight, plane.pattern, still);
    if (line.amplifier > 0) add(byAmplifier, line.amplifier, read);
    if (line.amplifierPattern > 0) add(byAmplifier, line.amplifierPattern, still);
  });
  const beyond = ({ resel, weight }) => weight.reduce((sum, w, i) => sum + w * w * moments.beyond[resel[i]], 0) / frames;
  noise.a += beyond(a);
  noise.b += beyond(b);
  return noise;
};
