// SPDX-License-Identifier: Apache-2.0
// How well a viewer sees each target, as studies/sight/: on the monitor of the camera's CCTV, or by eye. The verdicts
// are the study's; docs/console.md says how far the numbers agree. Undefined: the value does not exist.
const mostSnr = 1e6;
let options = data.sight;
// f() with some of the measures' constants changed.
const withOptions = (changed, f) => {
  options = { ...data.sight, ...changed };
  try {
    return f();
  } finally {
    options = data.sight;
  }
};

// Target transfer probability function of the Night Vision Laboratory.
const johnsonProbability = (cycles, needed) => {
  const r = cycles / needed;
  return r > 0 ? 1 / (1 + Math.exp(-(2.7 + 0.7 * r) * Math.log(r))) : 0;
};
const tasks = ["detect", "recognise", "identify"];
const chances = (cycles, most) => tasks.map((task) => Math.min(johnsonProbability(cycles, options.cycles[task]), most));

const logLuminance = (luminance) => Math.log10(Math.max(luminance, 1e-12));
// The least difference that an adapted eye sees, cd/m^2: cones or rods (Ferwerda et al. 1996).
const thresholdDifference = (luminance) => {
  const x = logLuminance(luminance);
  const cones = x <= -2.6 ? -0.72 : x >= 1.9 ? x - 1.255 : (0.249 * x + 0.65) ** 2.7 - 0.72;
  const rods = x <= -3.94 ? -2.86 : x >= -1.44 ? x - 0.395 : (0.405 * x + 1.6) ** 2.18 - 2.86;
  return 10 ** Math.min(cones, rods);
};
const acuity = (luminance) => Math.max(0, 17.25 * Math.atan(1.4 * logLuminance(luminance) + 0.35) + 25.72);
const seeingProbability = (ratio) => (ratio > 0 ? 1 - 2 ** -(ratio ** options.slope) : 0);

const snrOf = (signal, variance) => {
  if (signal === 0) return 0;
  const sigma = Math.sqrt(Math.max(variance, 0));
  return sigma * mostSnr > Math.abs(signal) ? signal / sigma : Math.sign(signal) * mostSnr;
};
// A difference of two float means below 1e-6 of them is a rounding error.
const differenceOf = (a, b) => (Math.abs(a - b) <= 1e-6 * (Math.abs(a) + Math.abs(b)) ? 0 : Math.abs(a - b));
const rootOfParts = (parts, difference) => Math.sqrt(parts.reduce((sum, part) => sum + part.share * difference(part) ** 2, 0));
const weberOf = (target, surround) => (surround > 0 ? (target - surround) / surround : undefined);

// Transfer of the picture's blurring stages along an axis, with area average, screen and phosphor.
const axisTransfer = ({ camera, monitor }, isAlong, f) => {
  const gaussian = (variance) => Math.exp(-variance * (1 - Math.cos(2 * Math.PI * f)));
  let product = gaussian(camera.lens_blur ** 2) * gaussian((isAlong ? camera.blur_h : camera.blur_v) ** 2) * sinc(f) ** 2;
  if (isAlong) {
    const b = (camera.bandwidth_mhz * 52.66) / monitor.columns;
    if (b > 0) product *= gaussian(b < 0.5 ? (0.5 * Math.LN2) / (1 - Math.cos(2 * Math.PI * b)) : Math.LN2 / (2 * Math.PI * b) ** 2);
    product *= 1 + camera.aperture_correction * (1 - Math.cos(2 * Math.PI * f));
  }
  const width = monitor.spread_width;
  if (monitor.spread === "gaussian") product *= Math.exp(-2 * ((Math.PI * width * f) / fwhmPerSigma) ** 2);
  if (monitor.spread === "triangle") product *= sinc(width * f) ** 2;
  if (monitor.spread === "sinc") product *= 2 * width * f < 1 ? 1 : 0;
  return product;
};

// Lag of a tube on a target that moves by `speed` resels per field.
const trailOf = (target, view, line) => {
  const along = (target.motion[0] * line.columns) / view.columns, across = (target.motion[1] * line.rows) / view.rows;
  const lag = line.lagPerField, speed = 0.5 * Math.hypot(along, across) * options.frame_s, direction = Math.atan2(across, along);
  const still = !(speed > 0 && lag > 0);
  const share = (extent) => {
    if (still) return 1;
    let sum = 0;
    for (let behind = 0, weight = 1 - lag; behind < extent && weight > 1e-9; behind += speed, weight *= lag) {
      sum += weight * (1 - behind / extent);
    }
    return sum;
  };
  const modulation = (to, f) =>
    still ? 1 : (1 - lag) / Math.sqrt(1 - 2 * lag * Math.cos(2 * Math.PI * f * speed * Math.cos(to - direction)) + lag * lag);
  return { share, modulation };
};

// Cycles per resel at which the modulation of the chain equals the least visible one.
const limitingFrequency = (model, trail, direction, needed) => {
  const least = (f) => {
    const variance = Math.min(needed.ofResel, needed.ofTarget * Math.max(1, 2 * f * needed.lines));
    return Math.max((3 * Math.sqrt(Math.max(variance, 0))) / needed.delta, needed.ofTheEye);
  };
  if (!(needed.delta > 0) || least(0) >= 1) return 0;
  const excess = (f) =>
    axisTransfer(model, true, Math.abs(f * Math.cos(direction))) * axisTransfer(model, false, Math.abs(f * Math.sin(direction))) *
    trail.modulation(direction, f) - least(f);
  const step = 1e-3, most = 0.5;
  for (let f = step; f < most; f += step) {
    const here = excess(f);
    if (here > 0) continue;
    const before = excess(f - step);
    return f - (step * (0 - here)) / (before - here);
  }
  return most;
};

// A target's sets of resels, which depend on the grids only.
const reselsKnown = new WeakMap();
const reselsOf = (target, view, line, { monitor }) => {
  const key = `${line.columns} ${line.rows} ${monitor.spread} ${monitor.spread_width} ${monitor.pixels_per_resel}`;
  const before = reselsKnown.get(target);
  if (before?.key === key) return before;
  const set = (pixels) => weigh(pixels, view, line);
  const sets = {
    key, measured: set(target.measured), seen: set(target.seen), surround: set(target.surround),
    parts: target.parts.map((part) => ({ target: set(part.target), surround: set(part.surround), share: part.share })),
  };
  sets.measuredScreen = screenSources(line, sets.measured);
  sets.surroundScreen = screenSources(line, sets.surround);
  reselsKnown.set(target, sets);
  return sets;
};

const unionOf = (sets, count) => {
  const has = new Uint8Array(count);
  for (const { resel } of sets) for (const at of resel) has[at] = 1;
  const all = [];
  has.forEach((one, i) => { if (one) all.push(i); });
  return all;
};

// On the monitor: adds snr, snrD, onMonitor (Weber contrast), threshold and chances.
const seeOnMonitor = (found, target, at, moments, line, view, model) => {
  const frames = Math.max(1, Math.round(options.eye_integration_s / options.frame_s));
  const lines = (target.extent.pixels * line.rows) / view.rows;
  let mean = meanOfSet(moments.mean, at.measured);
  const own = meanOfSet(moments.variance, at.measured);
  found.snr = snrOf(mean, own);
  found.lines = lines;
  if (at.surround.resel.length === 0) return;
  let shown = meanOfSet(moments.luminance, at.measuredScreen) + line.room;
  const surround = meanOfSet(moments.mean, at.surround), shownSurround = meanOfSet(moments.luminance, at.surroundScreen) + line.room;
  const trail = trailOf(target, view, line), left = trail.share(lines);
  if (left < 1) [mean, shown] = [surround + left * (mean - surround), shownSurround + left * (shown - shownSurround)];
  found.onMonitor = weberOf(shown, shownSurround);
  found.snr = snrOf(mean, own);
  const delta = differenceOf(mean, surround), both = 0.5 * (own + meanOfSet(moments.variance, at.surround));
  const noise = meanNoise(line, moments, at.seen, at.surround, frames), variance = noise.a + noise.b - 2 * noise.both;
  found.snrD = snrOf(delta, variance);
  let light = differenceOf(shown, shownSurround), signal = delta;
  if (at.parts.length > 0) {
    const ofParts = (values) => left * rootOfParts(at.parts, (part) => differenceOf(meanOfSet(values, part.target), meanOfSet(values, part.surround)));
    [light, signal] = [ofParts(moments.luminance), ofParts(moments.mean)];
  }
  const least = options.threshold_factor * thresholdDifference(Math.max(line.screenLuminance, shownSurround));
  if (shownSurround > 0) found.threshold = least / shownSurround;
  const frequency = limitingFrequency(model, trail, target.extent.direction_rad, {
    delta: signal, ofTarget: own > 0 ? (both * noise.a) / own : noise.a,
    ofResel: 0.5 * (meanOfSet(moments.varianceInTime, at.measured) + meanOfSet(moments.varianceInTime, at.surround)),
    ofTheEye: light > 0 ? least / light : 1, lines,
  });
  found.cycles = lines * frequency;
  found.chances = chances(found.cycles, Math.min(normalProbability(snrOf(signal, variance) - options.even_chance_snr), seeingProbability(light / least)));
};

const seeByEye = (found, target, luminance, mean) => {
  const difference = target.parts.length === 0 ? Math.abs(found.luminance - found.surround)
    : rootOfParts(target.parts, (part) => meanOver(luminance, part.target) - meanOver(luminance, part.surround));
  const least = options.threshold_factor * thresholdDifference(Math.max(mean, found.surround));
  if (found.surround > 0) found.threshold = least / found.surround;
  found.cycles = target.extent.angle_deg * acuity(mean);
  found.chances = chances(found.cycles, difference > 0 ? seeingProbability(difference / least) : 0);
};

const verdictOf = (target, { share, chances: p }) => {
  if (target.alone === 0) return target.in_frame ? "not-seen" : "out-of-view";
  if (!(share >= options.hidden_fraction)) return "hidden";
  if (!p) return "doubtful";
  const last = p[0] >= options.doubtful_probability ? "doubtful" : "not-seen";
  if (target.black_back / target.pixels >= options.most_black_back) return last;
  if (p[2] >= options.seen_probability) return "identified";
  if (p[1] >= options.seen_probability) return "recognised";
  return p[0] >= options.seen_probability ? "detected" : last;
};

// A camera without a CCTV of its own is judged by eye, unless a model or a setting of it was chosen.
const isByEye = (of) =>
  !data.cameras[of.camera].has_cctv && !of.model && Object.keys({ ...of.camera_set, ...of.monitor_set }).length === 0;

// Figures of the targets for which `wanted` holds. model: null for the eye.
const measureTargets = (light, model, wanted) => {
  const { view, luminance } = light, targets = view.targets.filter(wanted), seen = targets.filter((target) => target.pixels > 0);
  const mean = Math.max(0, luminance.reduce((sum, y) => sum + y, 0) / view.count);
  let line = null, moments = null;
  if (model && seen.length > 0) {
    line = passThrough(sensorLight(light, model), model, view.camera.fov_deg);
    const sets = seen.map((target) => reselsOf(target, view, line, model)), count = line.columns * line.rows;
    moments = momentsAt(line, unionOf(sets.flatMap((set) => [set.seen, set.surround]), count),
      unionOf(sets.flatMap((set) => [set.measuredScreen, set.surroundScreen]), count),
      Math.max(1, Math.round(options.eye_integration_s / options.frame_s)));
  }
  return targets.map((target) => {
    const found = { name: target.name, share: target.alone ? target.pixels / target.alone : undefined, exposure: line?.exposure };
    if (target.pixels > 0) {
      found.luminance = meanOver(luminance, target.measured);
      if (target.surround.length > 0) {
        found.surround = meanOver(luminance, target.surround);
        found.weber = weberOf(found.luminance, found.surround);
        if (!model) seeByEye(found, target, luminance, mean);
      }
      if (model) seeOnMonitor(found, target, reselsOf(target, view, line, model), moments, line, view, model);
    }
    found.verdict = verdictOf(target, found);
    return found;
  });
};

const viewerOf = (of) => (isByEye(of) ? null : modelOf(of));
const targetFigures = (light, of) => measureTargets(light, viewerOf(of), () => true);
