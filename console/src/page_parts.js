// SPDX-License-Identifier: Apache-2.0
// Shared by the pages of `earthshine view` and of the live preview.
const byId = (id) => document.getElementById(id);
const data = JSON.parse(byId("data").textContent);

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

// RGBA of a picture of one or three planes: with that white (null: its own), or in false colours with `top`, the power of
// ten of the brightest colour.
const pictureBytes = (planes, luminance, { white = null, top = null }) => {
  const bytes = new Uint8ClampedArray(4 * luminance.length), tone = toneOf(luminance, white);
  for (let i = 0; i < luminance.length; ++i) {
    const y = luminance[i];
    if (top !== null) {
      const k = 4 * falseIndex(y, top);
      for (let c = 0; c < 3; ++c) bytes[4 * i + c] = Number.isNaN(y) ? 0 : falseTable[k + c];
    } else {
      const scale = toneScale(tone, Math.max(0, y));
      const rgb = [0, 1, 2].map((c) => Math.max(0, planes[planes.length === 3 ? c : 0][i] * scale));
      const over = Math.max(1, ...rgb);
      for (let c = 0; c < 3; ++c) bytes[4 * i + c] = srgbByte(rgb[c] / over);
    }
    bytes[4 * i + 3] = 255;
  }
  return bytes;
};

// top: the power of ten of the brightest colour.
const showScale = (top, unit) => {
  byId("ramp").style.background = `linear-gradient(${falseAnchors.map((hex) => `#${hex}`).reverse().join(",")})`;
  byId("unit").textContent = unit;
  byId("marks").replaceChildren(...Array.from({ length: falseDecades + 1 }, (_, k) => {
    const mark = document.createElement("span");
    mark.textContent = (10 ** (top - k)).toPrecision(2);
    return mark;
  }));
};

const showFile = () => {
  byId("name").textContent = data.name;
  for (const layer of data.layers) byId("layer").add(new Option(layer.name));
  for (const [name, value] of data.facts) {
    for (const [tag, text] of [["dt", name], ["dd", value]]) {
      byId("facts").append(Object.assign(document.createElement(tag), { textContent: text }));
    }
  }
};

const showProblem = (error) => {
  byId("problem").hidden = false;
  byId("problem").textContent = `The page cannot show its data: ${error.message}`;
};
