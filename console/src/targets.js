// SPDX-License-Identifier: Apache-2.0
// How each target stands out: luminance and contrast over the pixels that `study` measures it by, and the line
// signal's ratio to its noise. The verdict is an estimate (docs/console.md): the program's own takes noise, eye and
// Johnson's criterion in full.
const targetFigures = (light, state) => {
  const { view, luminance } = light;
  const model = modelOf(state), law = noiseLaw(model.camera);
  const grid = pictureGrid(view.columns, view.rows, model.monitor);
  const exposure = exposureOf(model.camera, meteredLuminance(sensorLight(light, model), model.camera));
  const perLuminance = lensTransfer(model.camera, exposure.fNumber) / model.camera.white_lux;
  const reselsPerPixel = (grid.columns * grid.rows) / view.count;
  let mean = 0;
  for (const y of luminance) mean += y / luminance.length;
  const signalOf = (y) => perLuminance * ((1 - model.camera.glare) * y + model.camera.glare * mean);
  const variance = (s) => atBlack(law) + (law.b + law.c * s) * s;
  const most = Math.min(model.camera.saturation || Infinity, (model.camera.white_clip || Infinity) / exposure.gain);
  return view.targets.map((target) => {
    const found = { name: target.name, share: target.alone ? target.pixels / target.alone : null, verdict: "out of view" };
    if (target.alone === 0) return { ...found, verdict: target.in_frame ? "not seen" : "out of view" };
    if (found.share < 0.1) return { ...found, verdict: "hidden" };
    found.luminance = meanOver(luminance, target.measured);
    if (target.surround.length === 0) return { ...found, verdict: "doubtful" };
    found.surround = meanOver(luminance, target.surround);
    if (found.surround > 0) found.weber = (found.luminance - found.surround) / found.surround;
    const [s, b] = [found.luminance, found.surround].map((y) => Math.min(signalOf(y), most));
    found.snr = s / Math.sqrt(variance(s) || 1e-12);
    // Of the whole target in the 0.2 s over which the eye averages 6 frames (Rosell and Willson).
    const frames = 6, resels = (pixels) => Math.max(1, pixels.length * reselsPerPixel);
    const spread = Math.sqrt(variance(s) / resels(target.measured) / frames + variance(b) / resels(target.surround) / frames);
    found.snrD = Math.abs(s - b) / (spread || 1e-12);
    const contrast = Math.abs(s - b) / Math.max(b, 1e-12);
    const seen = found.snrD >= 2.8 && contrast >= 0.02;
    found.verdict = seen && target.black_back < 0.5 * target.pixels ? "clear" : found.snrD >= 1.5 && contrast >= 0.01 ? "doubtful" : "lost";
    return found;
  });
};
