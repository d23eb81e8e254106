// SPDX-License-Identifier: Apache-2.0
// The clean picture by WebGL2: a texture with a slice of half floats for each layer, summed in 32-bit floats and
// brought to 8 bits in one pass. Without WebGL2, or with more layers than a texture has slices: null.
const vertexShader = `#version 300 es
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}`;

const mostActive = 64;
const fragmentShader = `#version 300 es
precision highp float;
precision highp sampler2DArray;
uniform sampler2DArray layers;
uniform sampler2D falseColours;
uniform int count, rows, kind;  // kind 0: own exposure, 1: given white, 2: false colours
uniform int slice[${mostActive}];
uniform vec3 factor[${mostActive}];
uniform float exposure, white, top;
out vec4 shown;

vec3 srgb(vec3 x) {
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main() {
  ivec2 at = ivec2(int(gl_FragCoord.x), rows - 1 - int(gl_FragCoord.y));
  vec3 sum = vec3(0.0);
  for (int k = 0; k < count; ++k) sum += factor[k] * texelFetch(layers, ivec3(at, slice[k]), 0).rgb;
  float y = max(0.0, dot(sum, vec3(0.2126, 0.7152, 0.0722)));
  if (kind == 2) {
    float place = y > 0.0 ? 1.0 + (log2(y) * 0.30102999566 - top) / ${falseDecades}.0 : 0.0;
    shown = texelFetch(falseColours, ivec2(int(255.0 * clamp(place, 0.0, 1.0) + 0.5), 0), 0);
    return;
  }
  float signal = exposure * y, scale = exposure;
  if (kind == 0) {
    scale = exposure * (1.0 + signal / (white * white)) / (1.0 + signal);
  } else if (y > 0.0) {
    scale = (signal <= 0.6 ? signal : 1.0 - 0.4 * exp(-(signal - 0.6) / 0.4)) / y;
  }
  vec3 colour = max(sum * scale, 0.0);
  colour /= max(1.0, max(colour.r, max(colour.g, colour.b)));
  shown = vec4(floor(255.0 * srgb(colour) + 0.5) / 255.0, 1.0);
}`;

const makeGpu = () => {
  const canvas = document.createElement("canvas");
  const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, depth: false, preserveDrawingBuffer: true });
  if (!gl) return null;
  const program = makeProgram(gl, vertexShader, fragmentShader);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
  gl.useProgram(program);
  const place = (name) => gl.getUniformLocation(program, name);
  const uniforms = Object.fromEntries(
    ["layers", "falseColours", "count", "rows", "kind", "slice", "factor", "exposure", "white", "top"].map((name) => [name, place(name)]));
  const nearest = (target) => {
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  };
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.activeTexture(gl.TEXTURE1);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(falseTable));
  nearest(gl.TEXTURE_2D);
  gl.activeTexture(gl.TEXTURE0);
  let texture = null, loaded = null;

  // Whether the view's layers are on the card.
  const load = (view) => {
    if (loaded === view) return true;
    if (view.layers.length > gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS)) return false;
    gl.deleteTexture(texture);
    texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGB16F, view.columns, view.rows, Math.max(1, view.layers.length));
    nearest(gl.TEXTURE_2D_ARRAY);
    view.layers.forEach((layer, k) =>
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, k, view.columns, view.rows, 1, gl.RGB, gl.HALF_FLOAT, layer.halves));
    canvas.width = view.columns;
    canvas.height = view.rows;
    gl.viewport(0, 0, view.columns, view.rows);
    loaded = view;
    return true;
  };

  // A canvas with the picture, or null where it cannot be drawn so.
  const draw = (view, active, tone, top) => {
    if (gl.isContextLost() || active.length > mostActive || !load(view)) return null;
    const slices = new Int32Array(mostActive), factors = new Float32Array(3 * mostActive);
    active.forEach(([layer, factor], k) => {
      slices[k] = view.layers.indexOf(layer);
      factor.forEach((value, c) => { factors[3 * k + c] = value * layer.scale; });
    });
    gl.uniform1i(uniforms.layers, 0);
    gl.uniform1i(uniforms.falseColours, 1);
    gl.uniform1i(uniforms.count, active.length);
    gl.uniform1i(uniforms.rows, view.rows);
    gl.uniform1i(uniforms.kind, top !== null ? 2 : tone.kind === "own" ? 0 : 1);
    gl.uniform1iv(uniforms.slice, slices);
    gl.uniform3fv(uniforms.factor, factors);
    gl.uniform1f(uniforms.exposure, tone.exposure);
    gl.uniform1f(uniforms.white, tone.white);
    gl.uniform1f(uniforms.top, top ?? 0);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    return canvas;
  };
  return { draw };
};
