// SPDX-License-Identifier: Apache-2.0
// Linear maps along one axis of a picture, as degrade/stage/axis_map.cpp: sparse rows, mirrored at the border.
const leastTap = 1e-9; // weights below are left out

const mirrored = (index, size) => {
  const period = 2 * size, m = ((index % period) + period) % period;
  return m < size ? m : period - 1 - m;
};

const newMap = (size) => ({ in: size, start: [0], source: [], weight: [] });

const addOutput = (map, first, weights) => {
  let total = 0;
  for (const weight of weights) total += weight;
  const folded = new Map();
  weights.forEach((weight, k) => {
    if (Math.abs(weight) < leastTap * Math.abs(total)) return;
    const source = mirrored(first + k, map.in);
    folded.set(source, (folded.get(source) ?? 0) + weight / total);
  });
  for (const [source, weight] of [...folded].sort((a, b) => a[0] - b[0])) {
    map.source.push(source);
    map.weight.push(weight);
  }
  map.start.push(map.source.length);
};

const finished = (map) => ({
  in: map.in, out: map.start.length - 1, start: Int32Array.from(map.start), source: Int32Array.from(map.source),
  weight: Float64Array.from(map.weight),
});

// The last few hundred maps by their arguments.
const mapsKnown = new Map();
const known = (make) => (...given) => {
  const key = `${make.name} ${given.join(" ")}`;
  if (!mapsKnown.has(key)) {
    if (mapsKnown.size > 300) mapsKnown.clear();
    mapsKnown.set(key, make(...given));
  }
  return mapsKnown.get(key);
};

const areaAverage = known(function areaAverage(from, to) {
  const map = newMap(from);
  for (let i = 0; i < to; ++i) {
    const begin = (i * from) / to, end = ((i + 1) * from) / to;
    const first = Math.min(Math.floor(begin), from - 1), weights = [];
    for (let j = first; j < from && (j < end || j === first); ++j) {
      const share = Math.min(end, j + 1) - Math.max(begin, j);
      weights.push(share > 1e-12 * (from / to) ? share : 0);
    }
    addOutput(map, first, weights);
  }
  return finished(map);
});

// Lindeberg 1990: e^-t I_n(t), t = sigma^2, by the trapezium rule over the period.
const discreteGaussian = (sigma) => {
  if (!(sigma > 0)) return [1];
  const t = sigma * sigma, steps = Math.max(512, Math.ceil(16 * sigma)), half = [];
  for (let n = 0; n < steps / 2; ++n) {
    let sum = 0;
    for (let k = 0; k <= steps; ++k) {
      const end = k === 0 || k === steps ? 0.5 : 1, u = (Math.PI * k) / steps;
      sum += end * Math.exp(-t * (1 - Math.cos(u))) * Math.cos(n * u);
    }
    half.push(Math.max(0, sum / steps));
    if (half[n] <= 1e-10) break;
  }
  return [...half.slice(1).reverse(), ...half];
};

const symmetricFilter = (size, taps) => {
  const map = newMap(size), radius = (taps.length - 1) / 2;
  for (let i = 0; i < size; ++i) addOutput(map, i - radius, taps);
  return finished(map);
};

const gaussianBlur = known(function gaussianBlur(size, sigma) {
  return symmetricFilter(size, discreteGaussian(sigma));
});

// -3 dB at B along a line of 52.66 us (RS-170), then aperture correction.
const lineFilter = known(function lineFilter(size, bandwidth, correction, screenColumns) {
  let taps = [1];
  if (bandwidth > 0) {
    const f = (bandwidth * 52.66) / screenColumns;
    const variance = f < 0.5 ? (0.5 * Math.LN2) / (1 - Math.cos(2 * Math.PI * f)) : Math.LN2 / (4 * Math.PI ** 2 * f * f);
    taps = discreteGaussian(Math.sqrt(variance));
  }
  if (correction > 0) {
    const peaked = new Array(taps.length + 2).fill(0);
    taps.forEach((tap, i) => {
      peaked[i] -= 0.5 * correction * tap;
      peaked[i + 1] += (1 + correction) * tap;
      peaked[i + 2] -= 0.5 * correction * tap;
    });
    taps = peaked;
  }
  return symmetricFilter(size, taps);
});

// Complementary error function: the series of erf with positive terms below 2, beyond it Laplace's continued fraction.
const erfc = (x) => {
  const z = Math.abs(x), bell = Math.exp(-z * z) / Math.sqrt(Math.PI);
  let r;
  if (z < 2) {
    let sum = 0;
    for (let n = 0, term = 2 * z; term > 1e-17 * sum; ++n, term *= (2 * z * z) / (2 * n + 1)) sum += term;
    r = 1 - bell * sum;
  } else {
    let fraction = z;
    for (let n = 60; n > 0; --n) fraction = z + n / 2 / fraction;
    r = bell / fraction;
  }
  return x >= 0 ? r : 2 - r;
};

const sinc = (x) => (x === 0 ? 1 : Math.sin(Math.PI * x) / (Math.PI * x));
const sincZeros = 8;
const sincIntegral = (x) => {
  const steps = 2 * Math.max(1, Math.ceil(32 * x)), h = x / steps;
  let sum = 0;
  for (let k = 0; k <= steps; ++k) {
    const weight = k === 0 || k === steps ? 1 : k % 2 === 1 ? 4 : 2;
    sum += weight * sinc(k * h) * sinc((k * h) / sincZeros);
  }
  return (sum * h) / 3;
};
const fwhmPerSigma = 2 * Math.sqrt(2 * Math.LN2);
const spreadIntegral = (spread, width, x) => {
  if (spread === "gaussian") return 0.5 * erfc((-x * fwhmPerSigma) / (width * Math.SQRT2));
  if (spread === "triangle") {
    const tail = Math.max(0, 1 - Math.abs(x) / width);
    return x < 0 ? 0.5 * tail * tail : 1 - 0.5 * tail * tail;
  }
  if (spread === "sinc") {
    const zeros = Math.min(Math.abs(x) / width, sincZeros);
    return 0.5 + (Math.sign(x) * 0.5 * sincIntegral(zeros)) / sincIntegral(sincZeros);
  }
  return x < 0 ? 0 : 1;
};
const spreadReach = { gaussian: (w) => (6.5 * w) / fwhmPerSigma, triangle: (w) => w, sinc: (w) => sincZeros * w, none: () => 0 };

const spreadMap = known(function spreadMap(spread, width, resels, pixels) {
  const map = newMap(resels), radius = spreadReach[spread](width), phases = [];
  for (let phase = 0; phase < pixels; ++phase) {
    const x = (phase + 0.5) / pixels, first = Math.floor(x - radius), weights = [];
    for (let j = first; j <= Math.floor(x + radius); ++j) {
      weights.push(spreadIntegral(spread, width, x - j) - spreadIntegral(spread, width, x - j - 1));
    }
    phases.push({ first, weights });
  }
  for (let i = 0; i < resels; ++i) for (const { first, weights } of phases) addOutput(map, i + first, weights);
  return finished(map);
});

const isIdentity = (map) => map.in === map.out && map.source.length === map.in && map.weight.every((w) => w === 1);

const mapRows = (plane, columns, rows, map) => {
  const out = new Float32Array(map.out * rows), { start, source, weight } = map;
  for (let y = 0; y < rows; ++y) {
    const from = y * columns, to = y * map.out;
    for (let x = 0; x < map.out; ++x) {
      let sum = 0;
      for (let k = start[x]; k < start[x + 1]; ++k) sum += weight[k] * plane[from + source[k]];
      out[to + x] = sum;
    }
  }
  return out;
};

const mapColumns = (plane, columns, map) => {
  const out = new Float32Array(columns * map.out), { start, source, weight } = map, sum = new Float64Array(columns);
  for (let y = 0; y < map.out; ++y) {
    sum.fill(0);
    for (let k = start[y]; k < start[y + 1]; ++k) {
      const from = source[k] * columns, w = weight[k];
      for (let x = 0; x < columns; ++x) sum[x] += w * plane[from + x];
    }
    out.set(sum, y * columns);
  }
  return out;
};

const applyMaps = ({ columns, rows, planes }, along, across) => ({
  columns: along.out, rows: across.out,
  planes: planes.map((plane) => {
    const wide = isIdentity(along) ? plane : mapRows(plane, columns, rows, along);
    return isIdentity(across) ? wide : mapColumns(wide, along.out, across);
  }),
});

// Weights of magnitude below `least` are left out.
const withoutTapsBelow = (map, least) => {
  const kept = newMap(map.in);
  for (let i = 0; i < map.out; ++i) {
    for (let k = map.start[i]; k < map.start[i + 1]; ++k) {
      if (Math.abs(map.weight[k]) < least) continue;
      kept.source.push(map.source[k]);
      kept.weight.push(map.weight[k]);
    }
    kept.start.push(kept.source.length);
  }
  return finished(kept);
};

// `first`, then `second`.
const chained = (first, second) => {
  const both = newMap(first.in);
  for (let i = 0; i < second.out; ++i) {
    const sum = new Map();
    for (let k = second.start[i]; k < second.start[i + 1]; ++k) {
      const j = second.source[k];
      for (let m = first.start[j]; m < first.start[j + 1]; ++m) {
        sum.set(first.source[m], (sum.get(first.source[m]) ?? 0) + second.weight[k] * first.weight[m]);
      }
    }
    for (const [source, weight] of [...sum].sort((a, b) => a[0] - b[0])) {
      both.source.push(source);
      both.weight.push(weight);
    }
    both.start.push(both.source.length);
  }
  return finished(both);
};

const squaredMap = (map) => ({ ...map, weight: map.weight.map((w) => w * w) });
