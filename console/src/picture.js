// SPDX-License-Identifier: Apache-2.0
// The picture of a state: what the camera sees, or what its monitor shows, on a canvas of its own size.
const gpu = makeGpu();

const bytesToCanvas = (canvas, columns, rows, bytes) => {
  canvas.width = columns;
  canvas.height = rows;
  canvas.getContext("2d").putImageData(new ImageData(bytes, columns, rows), 0, 0);
  return canvas;
};

// The same as the fragment shader of gpu.js.
const cleanBytes = (view, active, luminance, tone, top) => {
  const bytes = new Uint8ClampedArray(4 * view.count);
  if (top !== null) {
    for (let i = 0; i < view.count; ++i) {
      const k = 4 * falseIndex(luminance[i], top);
      for (let c = 0; c < 4; ++c) bytes[4 * i + c] = falseTable[k + c];
    }
    return bytes;
  }
  const [r, g, b] = [0, 1, 2].map((c) => sumColour(view, active, c));
  for (let i = 0; i < view.count; ++i) {
    const scale = toneScale(tone, Math.max(0, luminance[i]));
    const red = Math.max(0, r[i] * scale), green = Math.max(0, g[i] * scale), blue = Math.max(0, b[i] * scale);
    const over = Math.max(1, red, green, blue);
    bytes[4 * i] = srgbByte(red / over);
    bytes[4 * i + 1] = srgbByte(green / over);
    bytes[4 * i + 2] = srgbByte(blue / over);
    bytes[4 * i + 3] = 255;
  }
  return bytes;
};

// What every readout needs, whatever is shown: {view, active, luminance}.
const lightOf = (view, state) => {
  const active = activeLayers(view, factorsOf(state), state.place);
  return { view, active, luminance: sumLuminance(view, active) };
};

const sensorLight = ({ view, active }, model) => {
  const grid = pictureGrid(view.columns, view.rows, model.monitor);
  const planes = model.camera.colour
    ? [0, 1, 2].map((c) => sumColour(view, active, c, grid))
    : [sumLuminance(view, active, grid)];
  return { ...grid, planes: planes.map((plane) => plane.map((value) => Math.max(0, value))) };
};

const monitorOf = (light, state, frame) =>
  runChain(sensorLight(light, modelOf(state)), modelOf(state), light.view.camera.fov_deg, frame);

const screenBytes = ({ screen, white }, top) => {
  const { planes } = screen, bytes = new Uint8ClampedArray(4 * planes[0].length), grey = planes.length === 1;
  for (let i = 0; i < planes[0].length; ++i) {
    if (top !== null) {
      const k = 4 * falseIndex(grey ? planes[0][i] : luminanceOf(planes.map((plane) => plane[i])), top);
      for (let c = 0; c < 3; ++c) bytes[4 * i + c] = falseTable[k + c];
    } else if (grey) {
      bytes[4 * i] = bytes[4 * i + 1] = bytes[4 * i + 2] = srgbByte(planes[0][i] / white);
    } else {
      for (let c = 0; c < 3; ++c) bytes[4 * i + c] = srgbByte(planes[c][i] / white);
    }
    bytes[4 * i + 3] = 255;
  }
  return bytes;
};

// canvas: where bytes are put if the card does not draw them. Returns the canvas to show, with the monitor's report.
const drawPicture = (canvas, light, state, frame) => {
  const { view, active, luminance } = light;
  if (state.view === "monitor") {
    const monitor = monitorOf(light, state, frame);
    const shown = bytesToCanvas(canvas, monitor.screen.columns, monitor.screen.rows, screenBytes(monitor, state.top));
    return { shown, monitor };
  }
  const tone = toneOf(luminance, state.white);
  const shown = gpu?.draw(view, active, tone, state.top) ??
    bytesToCanvas(canvas, view.columns, view.rows, cleanBytes(view, active, luminance, tone, state.top));
  return { shown, tone };
};
