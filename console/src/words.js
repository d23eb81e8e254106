// SPDX-License-Identifier: Apache-2.0
// The state as the program's words: a [[lamps]] table, a study file, a command.
const short = (value, digits = 6) => String(Number(Number(value).toPrecision(digits)));
const toml = (text) => JSON.stringify(String(text)).replace(/\x7f/g, "\\u007f");
const shellWord = (text) => (/^[\w./,=:@%+-]+$/.test(text) ? text : `'${String(text).replaceAll("'", "'\\''")}'`);

// [name, [R, G, B]] of the lights whose factor is not 1. Ambient light has none in the program.
const changedFactors = (of) => {
  const factors = factorsOf(of);
  return data.lights
    .map(({ name, kind }, k) => [name, factors[k], kind])
    .filter(([, factor, kind]) => kind !== "ambient" && factor.some((value) => value !== 1));
};
const factorText = (factor) => (isGrey(factor) ? short(factor[0]) : `[${factor.map((v) => short(v)).join(", ")}]`);

const lampsTable = (of) => {
  const set = changedFactors(of).map(([name, factor]) => `${toml(name)} = ${factorText(factor)}`);
  return `[[lamps]]\nname = "console"\n${set.length ? `set = { ${set.join(", ")} }\n` : ""}`;
};

const settingsText = (settings) =>
  Object.entries(settings).map(([name, value]) => `${name} = ${typeof value === "number" ? short(value) : toml(value)}\n`).join("");

// The camera's model as the program reads it, where it is not the scene's own.
const modelTables = (of) => {
  const camera = data.cameras[of.camera], isPreset = data.presets.some(({ name }) => name === modelOf(of).name);
  const changed = of.model || Object.keys(of.camera_set).length || !isPreset;
  if (!changed && !Object.keys(of.monitor_set).length) return "";
  const settings = isPreset ? of.camera_set : modelOf(of).camera;
  const table = `[[cctv]]\nname = "console"\n${isPreset ? `preset = ${toml(modelOf(of).name)}\n` : ""}${settingsText(settings)}`;
  const monitor = of.model || Object.keys(of.monitor_set).length ? `\n[monitor]\n${settingsText(modelOf(of).monitor)}` : "";
  return `\n${table}${monitor}\n[camera_models]\n${toml(camera.name)} = "console"\n`;
};

const studyText = (of) => {
  const camera = data.cameras[of.camera], place = data.places[of.place];
  const position = place.position_deg === null ? "" : `\n[orbit]\npositions_deg = [${short(place.position_deg)}]\n`;
  const set = data.set.length ? `set = [${data.set.map(toml).join(", ")}]\n` : "";
  return `format = 1\nname = "console"\nscene = ${toml(data.path)}\n${set}cameras = [${toml(camera.name)}]\n` +
    `size = "${camera.columns}x${camera.rows}"\n${position}\n${lampsTable(of)}${modelTables(of)}\n` +
    `[[picture]]\nname = "picture"\ncamera = ${toml(camera.name)}\nshows = "${of.view === "monitor" ? "cctv" : "clean"}"\n` +
    (place.position_deg === null ? "" : `position_deg = ${short(place.position_deg)}\n`);
};

// With the layers on disk a clean picture of its own exposure is a weighted sum of them; all else is a study.
const commandText = (of) => {
  const camera = data.cameras[of.camera];
  if (data.layers_folder && of.view === "clean" && of.white === null) {
    const set = changedFactors(of).map(([name, factor]) =>
      ` --set ${shellWord(`${name}=${isGrey(factor) ? short(factor[0]) : factor.map((v) => short(v)).join(",")}`)}`);
    return `earthshine relight ${shellWord(`${data.layers_folder}/${camera.file}.exr`)}${set.join("")} --png console.png`;
  }
  const exposure = of.view === "monitor" ? "" : of.white === null ? " --exposure own" : ` --exposure ${short(of.white)}cd/m2`;
  return `cat > console.toml <<'END'\n${studyText(of)}END\nearthshine study run console.toml -o console-study${exposure}`;
};

// "1.94 cd/m²", "2.1 mcd/m²".
const luminanceText = (y) => {
  if (!(y > 0)) return "0 cd/m²";
  const [unit, times] = y >= 1000 ? ["kcd/m²", 1e-3] : y >= 0.1 ? ["cd/m²", 1] : y >= 1e-4 ? ["mcd/m²", 1e3] : ["µcd/m²", 1e6];
  return `${short(y * times, 3)} ${unit}`;
};
