// SPDX-License-Identifier: Apache-2.0
// Why a target is not seen better: causes are removed one at a time and the sight is measured again, as
// studies/why/why_not.cpp. Without its causes that need the scene's geometry: shadows, distances, bright things.
const leastGain = 0.1;

// [words, how the rest is called, light, model, changed constants].
const changesOf = (light, of, target, figures) => {
  const model = viewerOf(of), changes = [];
  data.lights.forEach((source, k) => {
    const factor = factorsOf(of)[k];
    const isOff = factor.every((value) => value === 0), canDim = source.kind === "lamp" || source.kind === "group";
    if (source.kind === "ambient" || !(isOff || (canDim && factor.some((value) => value < 1)))) return;
    const on = factorsOf(of).map((value, n) => (n === k ? value.map((v) => Math.max(v, 1)) : value));
    const active = activeLayers(light.view, on, of.place);
    changes.push([`unlit: ${source.name} ${isOff ? "switched off" : "dimmed"}`, "with it", { ...light, active, luminance: sumLuminance(light.view, active) }, model, {}]);
  });
  const cctv = (words, camera, monitor = {}) => changes.push([words, "without it", light,
    { ...model, camera: { ...model.camera, ...camera }, monitor: { ...model.monitor, ...monitor } }, {}]);
  if (model) {
    const { camera, monitor } = model, { exposure } = figures;
    const level = (Math.max(figures.luminance, figures.surround ?? 0) * lensTransfer(camera, exposure.fNumber) * exposure.gain) / camera.white_lux;
    if (level >= 0.9) {
      cctv("saturated", { iris: "fixed", f_number: exposure.fNumber * 2 ** (0.5 * Math.max(2, Math.log2(2 * level))), gain_db: 20 * Math.log10(exposure.gain) });
    }
    if (camera.lag > 0 && Math.hypot(...target.motion) > 0) cctv("smeared by the tube's lag", { lag: 0 });
    if (camera.lens_blur > 0) cctv("blurred by the lens", { lens_blur: 0 });
    if (camera.blur_h > 0 || camera.blur_v > 0) cctv("blurred by the sensor", { blur_h: 0, blur_v: 0 });
    if (camera.bandwidth_mhz > 0) cctv("blurred by the video line", { bandwidth_mhz: 0, aperture_correction: 0 });
    if (monitor.spread !== "none") cctv("blurred by the monitor", {}, { spread: "none", pixels_per_resel: 1 });
    if (camera.noise !== "none") cctv("lost in noise", { noise: "none" });
    if (monitor.reflectance * monitor.room_illuminance > 0) cctv("washed out by the room's light on the monitor", {}, { room_illuminance: 0 });
  }
  return changes;
};
const viewerChanges = (light, of) => [
  ["too little contrast for the eye's threshold", "without one", light, viewerOf(of), { threshold_factor: 0 }],
  ["too small", "if it were large", light, viewerOf(of), { cycles: Object.fromEntries(tasks.map((task) => [task, 1e-9])) }],
];

const hiddenText = (target) => {
  const [first, ...others] = target.hidden_by.filter(([, pixels], k) => k === 0 || pixels >= 0.05 * target.alone).slice(0, 3)
    .map(([object, pixels]) => `${data.objects[object]} (${Math.round((100 * pixels) / target.alone)} % of it)`);
  return first ? `hidden by ${[first, ...others].join(", ")}` : "hidden";
};

// Yields after each measurement, so that the page stays alive; returns the words.
const reasonSteps = function* reasonSteps(light, of, target, figures) {
  if (target.alone === 0) return target.in_frame ? "smaller than a pixel of the picture" : "out of the camera's view";
  if (figures.verdict === "hidden") return hiddenText(target);
  if (target.black_back >= options.most_black_back * target.pixels) return "black back seen: its surface has one side";
  if (!figures.chances) return "fills the picture: nothing to tell it from";
  const task = figures.chances.findIndex((p) => p < options.seen_probability);
  if (task < 0) return "";
  const prefix = ["", "not recognised: ", "not identified: "][task], now = figures.chances[task], tried = [];
  const isCure = ({ p }) => p >= options.seen_probability;
  for (const changes of [() => changesOf(light, of, target, figures), () => viewerChanges(light, of)]) {
    for (const [words, without, changed, model, constants] of changes()) {
      const [found] = withOptions(constants, () => measureTargets(changed, model, (one) => one === target));
      const p = found.chances?.[task] ?? 0;
      tried.push({ p, text: `${words}${words.includes(":") ? ";" : ":"} ${without} ${p.toFixed(2)}` });
      yield null;
    }
    if (tried.some(isCure)) break;
  }
  const cures = tried.filter(isCure), helps = cures.length > 0 ? cures : tried.filter(({ p }) => p >= now + leastGain);
  const hidden = 1 - figures.share >= 0.1 ? [hiddenText(target)] : [];
  const reasons = [...hidden, ...helps.map(({ text }) => text)];
  return prefix + (reasons.length > 0 ? reasons.join("; ") : "no single cause");
};
