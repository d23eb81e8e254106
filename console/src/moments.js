// SPDX-License-Identifier: Apache-2.0
// Point maps of the signal and the moments of Gaussian noise through them, as degrade/stage/point_map.cpp and
// degrade/moments/point_moments.cpp: the same quadrature, the same table, so that verdicts are the program's.
const normalProbability = (z) => 0.5 * erfc(-z / Math.SQRT2);
const normalDensity = (z) => Math.exp(-0.5 * z * z) / Math.sqrt(2 * Math.PI);

const pointSteps = {
  below: (v, least) => Math.max(v, least),
  above: (v, most) => Math.min(v, most),
  amplify: (v, gain) => v * gain,
  shift: (v, by) => v + by,
  power: (v, exponent) => (v > 0 ? v ** exponent : 0),
  quantise: (v, steps) => Math.round(Math.min(Math.max(v, 0), 1) * steps) / steps,
};
// The signal behind the value of a step; undefined: none, or an interval whose ends are kinks already.
const pointInverses = {
  below: (v, least) => (v <= least ? undefined : v),
  above: (v, most) => (v >= most ? undefined : v),
  amplify: (v, gain) => v / gain,
  shift: (v, by) => v - by,
  power: (v, exponent) => (v <= 0 ? undefined : v ** (1 / exponent)),
  quantise: () => undefined,
};

// steps: [[kind, parameter], ...]. The map is smooth between its kinks.
const pointMap = (steps) => {
  const at = (signal, count = steps.length) => {
    for (let k = 0; k < count; ++k) signal = pointSteps[steps[k][0]](signal, steps[k][1]);
    return signal;
  };
  let kinks = [];
  steps.forEach(([kind, parameter], k) => {
    let values = kind === "below" || kind === "above" ? [parameter] : kind === "power" ? [0] : [];
    if (kind === "quantise") values = Array.from({ length: parameter }, (_, i) => (i + 0.5) / parameter);
    for (let v of values) {
      for (let j = k - 1; j >= 0 && v !== undefined; --j) v = pointInverses[steps[j][0]](v, steps[j][1]);
      if (v !== undefined) kinks.push(v);
    }
  });
  kinks = [...new Set(kinks)].sort((a, b) => a - b);
  // The interval before each kink and after the last one: its value if the map is level there.
  const stretches = Array.from({ length: kinks.length + 1 }, (_, k) => {
    if (kinks.length === 0) return null;
    const left = k > 0 ? kinks[k - 1] : kinks[0] - 1, right = k < kinks.length ? kinks[k] : kinks.at(-1) + 1;
    const value = at(0.75 * left + 0.25 * right);
    return value === at(0.25 * left + 0.75 * right) ? value : null;
  });
  return { at, kinks, stretches };
};

// Gauss and Legendre's rule on [0, 1].
const gaussRule = known(function gaussRule(points) {
  const rule = [];
  for (let k = points; k > 0; --k) {
    let x = Math.cos((Math.PI * (k - 0.25)) / (points + 0.5)), slope = 0;
    for (let step = 0; step < 50; ++step) {
      let here = 1, before = 0;
      for (let n = 0; n < points; ++n) [here, before] = [((2 * n + 1) * x * here - n * before) / (n + 1), here];
      slope = (points * (x * here - before)) / (x * x - 1);
      const move = here / slope;
      x -= move;
      if (Math.abs(move) < 1e-15) break;
    }
    rule.push([0.5 * (1 + x), 1 / ((1 - x * x) * slope * slope)]);
  }
  return rule;
});

const momentReach = 8.5; // sigma
const farWeights = (() => {
  const w = Array.from({ length: 13 }, (_, k) => normalDensity(k - 6)), total = w.reduce((a, b) => a + b);
  return w.map((value) => value / total);
})();

// [mean, variance, slope] of f(S) for a normal S.
const momentsThrough = (map, mean, sigma) => {
  const reference = map.at(mean), { kinks } = map;
  if (!(sigma > 0)) return [reference, 0, 0];
  const sums = [0, 0, 0, 0];
  const add = (value, z, weight) => {
    sums[0] += weight * value;
    sums[1] += weight * value * value;
    sums[2] += weight * value * z;
    sums[3] += weight * value * (z * z - 1);
  };
  const found = () =>
    [reference + sums[0], Math.max(sums[1] - sums[0] ** 2, sums[2] ** 2 + 0.5 * sums[3] ** 2), sums[2] / sigma];
  const inReach = (signal) => {
    let k = 0;
    while (k < kinks.length && kinks[k] < signal) ++k;
    return k;
  };
  const first = inReach(mean - momentReach * sigma), last = inReach(mean + momentReach * sigma);
  if (first === last) {
    if (map.stretches[first] !== null) return [reference, 0, 0];
    for (let k = 0; k < 13; ++k) add(map.at(mean + sigma * (k - 6)) - reference, k - 6, farWeights[k]);
    return found();
  }
  const g = (z) => map.at(mean + sigma * z) - reference;
  let a = -momentReach, below = 0, density = 0;
  for (let k = first; k <= last; ++k) {
    const b = k < last ? (kinks[k] - mean) / sigma : momentReach;
    const belowB = k < last ? normalProbability(b) : 1, densityB = k < last ? normalDensity(b) : 0;
    const level = map.stretches[k];
    if (level !== null) {
      const value = level - reference;
      sums[0] += value * (belowB - below);
      sums[1] += value * value * (belowB - below);
      sums[2] += value * (density - densityB);
      sums[3] += value * (a * density - b * densityB);
    } else {
      let from = a;
      if (k > first) {
        const end = Math.min(b, from + 2); // the slope may be infinite at the kink: z = from + (end - from) t^3
        for (const [t, w] of gaussRule(14)) {
          const z = from + (end - from) * t * t * t;
          add(g(z), z, 3 * t * t * (end - from) * w * normalDensity(z));
        }
        from = end;
      }
      const panels = Math.ceil((b - from) / 4), width = (b - from) / Math.max(1, panels);
      for (let panel = 0; panel < panels; ++panel) {
        for (const [node, w] of gaussRule(10)) {
          const z = from + (panel + node) * width;
          add(g(z), z, width * w * normalDensity(z));
        }
      }
    }
    [a, below, density] = [b, belowB, densityB];
  }
  return found();
};

const tableSpacing = 0.2, tableLogSpacing = 0.1; // in mean / sigma, and in ln sigma
// Lagrange's weights of the nodes -2 to 3 at t in [0, 1].
const lagrange = (t, into) => {
  const a = t + 2, b = t + 1, d = t - 1, e = t - 2, f = t - 3, ab = a * b, td = t * d, ef = e * f;
  into[0] = (-b * td * ef) / 120;
  into[1] = (a * td * ef) / 24;
  into[2] = (-ab * d * ef) / 12;
  into[3] = (ab * t * ef) / 12;
  into[4] = (-ab * td * f) / 24;
  into[5] = (ab * td * e) / 120;
};

// Moments at nodes of mean / sigma and ln sigma where that saves time; interpolated by polynomials of degree 5.
const momentTable = (map, means, variances) => {
  const uses = new Map(), rows = new Map(), levels = new Set();
  const levelOf = (sigma) => Math.floor(Math.log(sigma) / tableLogSpacing);
  const rowSigma = (level) => Math.exp(level * tableLogSpacing);
  means.forEach((mean, i) => {
    if (!(variances[i] > 0)) return;
    const level = levelOf(Math.sqrt(variances[i])), use = uses.get(level) ?? { low: Infinity, high: -Infinity, count: 0 };
    use.low = Math.min(use.low, mean);
    use.high = Math.max(use.high, mean);
    ++use.count;
    uses.set(level, use);
  });
  for (const [level, { low, high, count }] of uses) {
    const nodes = 6 * ((high - low) / (tableSpacing * rowSigma(level - 2)) + 6);
    if (!(2 * nodes < count)) continue;
    levels.add(level);
    for (let k = level - 2; k <= level + 3; ++k) {
      const sigma = rowSigma(k), row = rows.get(k) ?? { sigma, first: Infinity, last: -Infinity };
      row.first = Math.min(row.first, Math.floor(low / (tableSpacing * sigma)) - 2);
      row.last = Math.max(row.last, Math.floor(high / (tableSpacing * sigma)) + 3);
      rows.set(k, row);
    }
  }
  for (const row of rows.values()) {
    row.at = new Float64Array(3 * (row.last - row.first + 1));
    for (let i = 0; 3 * i < row.at.length; ++i) {
      row.at.set(momentsThrough(map, (row.first + i) * tableSpacing * row.sigma, row.sigma), 3 * i);
    }
  }
  const across = new Float64Array(6), along = new Float64Array(6), all = [0, 0, 0];
  return (mean, sigma) => {
    const logSigma = Math.log(sigma) / tableLogSpacing, level = Math.floor(logSigma);
    if (!levels.has(level)) return null;
    lagrange(logSigma - level, across);
    let [m, v, s] = [0, 0, 0];
    for (let j = 0; j < 6; ++j) {
      const { at, sigma: ofRow, first } = rows.get(level - 2 + j), place = mean / (tableSpacing * ofRow), node = Math.floor(place);
      lagrange(place - node, along);
      for (let k = 0, i = 3 * (node - 2 - first); k < 6; ++k, i += 3) {
        const weight = across[j] * along[k];
        m += weight * at[i];
        v += weight * at[i + 1];
        s += weight * at[i + 2];
      }
    }
    s = Math.max(s, 0); // the polynomial may overshoot
    [all[0], all[1], all[2]] = [m, Math.max(v, (s * sigma) ** 2), s];
    return all;
  };
};

// Of each mean and variance: planes of means, variances and slopes.
const momentsOfAll = (map, means, variances) => {
  const table = momentTable(map, means, variances), found = [0, 1, 2].map(() => new Float32Array(means.length));
  for (let i = 0; i < means.length; ++i) {
    const sigma = Math.sqrt(Math.max(0, variances[i])), all = (sigma > 0 ? table(means[i], sigma) : null) ?? momentsThrough(map, means[i], sigma);
    for (let k = 0; k < 3; ++k) found[k][i] = all[k];
  }
  return found;
};
