// SPDX-License-Identifier: Apache-2.0
// Noise of the linear signal, sigma^2 = a + b S + c S^2, as degrade/parts/noise.h with Gaussian numbers throughout:
// variance and correlation are the program's, the skewness of few electrons is not.
const noiseLaw = (camera) => {
  const law = { a: 0, b: 0, c: 0, fixed: false, dark: 0, blackPattern: 0 };
  const whiteOverRms = 10 ** (camera.snr_db / 20), n = camera.electrons_at_white;
  if (camera.noise === "report") law.c = 1 / whiteOverRms ** 2;
  if (camera.noise === "spec") law.a = 1 / whiteOverRms ** 2;
  if (camera.noise === "law") Object.assign(law, { a: camera.noise_a, b: camera.noise_b, c: camera.noise_c });
  if (camera.noise === "photon") {
    law.a = (camera.read_electrons / n) ** 2;
    law.b = camera.excess_noise / n;
    law.c = (camera.prnu_percent / 100) ** 2;
    law.fixed = true;
    law.dark = (camera.excess_noise * camera.dark_electrons) / (n * n);
    law.blackPattern = (camera.dsnu_percent / 100) ** 2;
  }
  return law;
};

const atBlack = (law) => law.a + law.dark + law.blackPattern;

// 2^18 standard normal numbers (Box and Muller) from a 32-bit generator (mulberry32); a picture's rows read them
// from places of their own.
const generator = (seed) => () => {
  seed = (seed + 0x6d2b79f5) | 0;
  let t = Math.imul(seed ^ (seed >>> 15), 1 | seed);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
};
let normalTable = null;
const normals = () => {
  if (normalTable) return normalTable;
  const draw = generator(1);
  normalTable = new Float32Array(1 << 18);
  for (let i = 0; i < normalTable.length; i += 2) {
    const radius = Math.sqrt(-2 * Math.log(1 - draw())), angle = 2 * Math.PI * draw();
    normalTable[i] = radius * Math.cos(angle);
    normalTable[i + 1] = radius * Math.sin(angle);
  }
  return normalTable;
};

// f(value, normal number) at each resel; `key` names the numbers.
const withNormals = (picture, key, f) => {
  const table = normals(), mask = table.length - 1;
  return {
    ...picture,
    planes: picture.planes.map((plane, p) => {
      const draw = generator(Math.imul(key, 7919) + p), out = new Float32Array(plane.length);
      for (let row = 0; row < picture.rows; ++row) {
        let at = (draw() * table.length) | 0;
        for (let i = row * picture.columns, end = i + picture.columns; i < end; ++i) {
          out[i] = f(plane[i], table[at++ & mask]);
        }
      }
      return out;
    }),
  };
};

const fixedKey = 1; // of what stays from frame to frame
const addSignalNoise = (picture, law, key) => {
  if (law.fixed && law.c > 0) {
    const spread = Math.sqrt(law.c);
    picture = withNormals(picture, fixedKey, (s, z) => s * (1 + spread * z));
  }
  const c = law.fixed ? 0 : law.c;
  if (!(law.b > 0 || c > 0 || law.dark > 0)) return picture;
  return withNormals(picture, key, (s, z) => {
    const light = s > 0 ? s : 0;
    return s + Math.sqrt(law.dark + (law.b + c * light) * light) * z;
  });
};
const addReadNoise = (picture, law, key) => {
  if (law.blackPattern > 0) {
    const spread = Math.sqrt(law.blackPattern);
    picture = withNormals(picture, fixedKey + 1, (s, z) => s + spread * z);
  }
  if (!(law.a > 0)) return picture;
  const spread = Math.sqrt(law.a);
  return withNormals(picture, key, (s, z) => s + spread * z);
};
