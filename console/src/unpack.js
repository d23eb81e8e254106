// SPDX-License-Identifier: Apache-2.0
// The inverse of app/console/pack.cpp: base64, zlib, residuals of a predictor.
const unpackBytes = async (id) => {
  const text = atob(document.getElementById(id).textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
};

// One plane of 16-bit numbers from its residuals: low bytes, then high bytes. MED predictor (ISO 14495-1).
const unpackPlane = (bytes, at, columns, count) => {
  const plane = new Uint16Array(count);
  for (let i = 0; i < count; ++i) {
    const hasLeft = i % columns !== 0, hasAbove = i >= columns;
    let guess = 0x8000;
    if (hasLeft && hasAbove) {
      const left = plane[i - 1], above = plane[i - columns], corner = plane[i - columns - 1];
      const low = left < above ? left : above, high = left < above ? above : left;
      guess = corner >= high ? low : corner <= low ? high : left + above - corner;
    } else if (hasLeft) {
      guess = plane[i - 1];
    } else if (hasAbove) {
      guess = plane[i - columns];
    }
    const folded = bytes[at + i] | (bytes[at + count + i] << 8);
    plane[i] = guess + ((folded >> 1) ^ -(folded & 1));
  }
  return plane;
};

const halfOfOrdered = (number) => (number >= 0x8000 ? number - 0x8000 : 0x8000 | (0x8000 - number));

// Halves of R, G and B side by side, as textures take them; null for a black layer.
const unpackLayer = async (layer, columns, rows) => {
  if (!layer.data) return null;
  const bytes = await unpackBytes(layer.data);
  const count = columns * rows, halves = new Uint16Array(3 * count);
  const green = unpackPlane(bytes, 0, columns, count);
  for (const [colour, at] of [[0, 2 * count], [2, 4 * count]]) {
    const difference = unpackPlane(bytes, at, columns, count);
    for (let i = 0; i < count; ++i) {
      halves[3 * i + colour] = halfOfOrdered((difference[i] + green[i] - 0x8000) & 0xffff);
    }
  }
  for (let i = 0; i < count; ++i) halves[3 * i + 1] = halfOfOrdered(green[i]);
  return halves;
};

// Ascending pixel indices from runs of (gap, length).
const unpackRuns = async (id) => {
  if (!id) return new Uint32Array(0);
  const bytes = await unpackBytes(id);
  const runs = new Uint32Array(bytes.buffer, 0, bytes.length / 4);
  let count = 0;
  for (let k = 1; k < runs.length; k += 2) count += runs[k];
  const indices = new Uint32Array(count);
  for (let k = 0, at = 0, pixel = 0; k < runs.length; k += 2) {
    pixel += runs[k];
    for (let i = 0; i < runs[k + 1]; ++i) indices[at++] = pixel++;
  }
  return indices;
};

const unpackObjects = async (id) => {
  const bytes = await unpackBytes(id);
  return new Uint16Array(bytes.buffer, 0, bytes.length / 2); // 0: no object
};
