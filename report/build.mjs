// SPDX-License-Identifier: Apache-2.0
// node build.mjs FOLDER: bundles the script and its libraries into FOLDER/script.js, with its hash
// for the page's policy (script.hash) and the licences of what is in it (licences.txt).
// node build.mjs --check: exit code 0 where that would work.
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));

const bundle = () =>
  build({
    entryPoints: [join(here, "src/main.js")],
    absWorkingDir: here,
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: "iife",
    target: ["chrome109", "firefox115", "safari16"],
    legalComments: "none", // the licences are beside it
    charset: "ascii",
    logLevel: "warning",
  });

// "node_modules/@scope/name/…" -> "@scope/name".
const packageOf = (input) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input)?.[1];

const licenceText = (name) => {
  const folder = join(here, "node_modules", name);
  const file = readdirSync(folder).find((entry) => /^licen[cs]e(\.|$)/i.test(entry));
  if (file) return readFileSync(join(folder, file), "utf8").trim();
  const kept = join(here, "licences", `${name}.txt`); // packages that come without one
  if (existsSync(kept)) return readFileSync(kept, "utf8").trim();
  throw new Error(`${name}: no licence text in the package nor in report/licences`);
};

// One entry per package; packages with the same text share it.
const licences = (inputs) => {
  const names = [...new Set(inputs.map(packageOf).filter(Boolean))].sort();
  const byText = new Map();
  for (const name of names) {
    const { version, license } = JSON.parse(
      readFileSync(join(here, "node_modules", name, "package.json"), "utf8"),
    );
    const text = licenceText(name);
    byText.set(text, [...(byText.get(text) ?? []), `${name} ${version} (${license})`]);
  }
  return [...byText].map(([text, users]) => `${users.join("\n")}\n\n${text}\n`).join("\n\n");
};

const result = await bundle();
if (process.argv[2] !== "--check") {
  // "</script" inside a string would end the element.
  const script = result.outputFiles[0].text.replaceAll(/<\/(script)/gi, "<\\/$1").trim();
  const folder = process.argv[2] ?? join(here, "out");
  const used = Object.values(result.metafile.outputs).flatMap(({ inputs }) =>
    Object.keys(inputs).filter((input) => inputs[input].bytesInOutput > 0),
  );
  mkdirSync(folder, { recursive: true });
  const hash = `sha256-${createHash("sha256").update(script).digest("base64")}`;
  writeFileSync(join(folder, "script.js"), script);
  writeFileSync(join(folder, "script.hash"), hash);
  writeFileSync(join(folder, "licences.txt"), licences(used));
}
