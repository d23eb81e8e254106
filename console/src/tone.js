// SPDX-License-Identifier: Apache-2.0
// From luminance to display, as base/tone.cpp: the photographic operator of Reinhard et al. 2002 with an exposure
// of its own, or a given white with a shoulder.

// The value of rank `rank` of non-negative floats: their bits have the order of their values. `counts` has one
// entry for each upper half of the bits.
const valueOfRank = (values, rank) => {
  const bits = new Uint32Array(values.buffer, values.byteOffset, values.length);
  const upper = new Uint32Array(32768), lower = new Uint32Array(65536);
  for (let i = 0; i < bits.length; ++i) ++upper[bits[i] >>> 16];
  let head = 0;
  while (rank >= upper[head]) rank -= upper[head++];
  for (let i = 0; i < bits.length; ++i) if (bits[i] >>> 16 === head) ++lower[bits[i] & 0xffff];
  let tail = 0;
  while (rank >= lower[tail]) rank -= lower[tail++];
  return new Float32Array(new Uint32Array([(head << 16) | tail]).buffer)[0];
};

const litOf = (luminance) => {
  const lit = new Float32Array(luminance.length);
  let count = 0;
  for (let i = 0; i < luminance.length; ++i) if (luminance[i] > 0) lit[count++] = luminance[i];
  return lit.subarray(0, count);
};

// {exposure, white}: signal = exposure * luminance, white in units of the signal.
const ownExposure = (luminance) => {
  const lit = litOf(luminance);
  if (lit.length === 0) return { exposure: 1, white: 1 };
  const percentile = valueOfRank(lit, Math.round(0.995 * (lit.length - 1)));
  let sum = 0, count = 0;
  for (let i = 0; i < lit.length; ++i) {
    if (lit[i] < 1e-5 * percentile) continue;
    sum += Math.log(lit[i]);
    ++count;
  }
  const exposure = 0.18 / Math.exp(sum / count);
  return { exposure, white: Math.max(1, exposure * percentile) };
};

// cdPerM2: null for the picture's own exposure.
const toneOf = (luminance, cdPerM2) =>
  cdPerM2 === null
    ? { kind: "own", ...ownExposure(luminance) }
    : { kind: "white", exposure: 1 / cdPerM2, white: 1 };

// Colour shown over colour there.
const toneScale = (tone, y) => {
  const signal = tone.exposure * y;
  if (tone.kind === "own") return (tone.exposure * (1 + signal / (tone.white * tone.white))) / (1 + signal);
  if (!(y > 0)) return tone.exposure;
  return (signal <= 0.6 ? signal : 1 - 0.4 * Math.exp(-(signal - 0.6) / 0.4)) / y;
};

const srgbCurve = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const linearOfSrgb = (s) => (s <= 0.04045 ? s / 12.92 : ((s + 0.055) / 1.055) ** 2.4);

// 8 bits of a linear value, exactly as base::srgb_byte: where each byte begins, and the byte of 4096 cells.
const srgbSteps = (() => {
  const begin = new Float64Array(257).fill(2), first = new Uint8Array(4097);
  for (let byte = 1; byte < 256; ++byte) begin[byte] = linearOfSrgb((byte - 0.5) / 255);
  begin[0] = 0;
  for (let cell = 0, byte = 0; cell <= 4096; ++cell) {
    while (byte < 255 && begin[byte + 1] <= cell / 4096) ++byte;
    first[cell] = byte;
  }
  return { begin, first };
})();
const srgbByte = (x) => {
  if (!(x > 0)) return 0;
  if (x >= 1) return 255;
  let byte = srgbSteps.first[(x * 4096) | 0];
  while (x >= srgbSteps.begin[byte + 1]) ++byte;
  return byte;
};

// False colours: equal steps of lightness over four decades (the anchors of viridis).
const falseAnchors = ["440154", "482878", "3e4a89", "31688e", "26828e", "1f9e89", "35b779", "6ece58", "b5de2b", "fde725"];
const falseDecades = 4;
const falseTable = (() => {
  const anchors = falseAnchors.map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  const table = new Uint8ClampedArray(256 * 4);
  for (let k = 0; k < 256; ++k) {
    const at = (k / 255) * (anchors.length - 1), low = Math.min(anchors.length - 2, Math.floor(at));
    for (const c of [0, 1, 2]) table[4 * k + c] = anchors[low][c] + (at - low) * (anchors[low + 1][c] - anchors[low][c]);
    table[4 * k + 3] = 255;
  }
  return table;
})();
// top: the power of ten of the brightest colour.
const falseIndex = (y, top) =>
  y > 0 ? Math.max(0, Math.min(255, Math.round(255 * (1 + (Math.log10(y) - top) / falseDecades)))) : 0;
const falseTopOf = (luminance) => {
  const lit = litOf(luminance);
  if (lit.length === 0) return 0;
  return Math.ceil(Math.log10(valueOfRank(lit, Math.round(0.995 * (lit.length - 1)))));
};
