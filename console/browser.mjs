// SPDX-License-Identifier: Apache-2.0
// Headless Chromium for the tests of the console's pages: ends with exit code 77 if there is no browser or no
// node_modules.
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};
const browserPath = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find((path) => existsSync(path));
if (!browserPath) skip("no Chromium at /usr/bin/chromium");
const modules = createRequire(join(dirname(fileURLToPath(import.meta.url)), "../report/package.json"));
let chromium;
try {
  ({ chromium } = modules("playwright-core"));
} catch {
  skip("playwright-core is not in report/node_modules");
}
const axeText = readFileSync(modules.resolve("axe-core/axe.min.js"), "utf8");

// WebGL2 by software, so that a machine without graphics runs the shader too.
const browser = await chromium.launch({
  executablePath: browserPath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

let faults = 0;
export const check = (holds, what, found = "") => {
  console.log(`${holds ? "ok   " : "FAULT"} ${what}${found === "" ? "" : `: ${found}`}`);
  if (!holds) ++faults;
};

// mayAsk: of a request's address. complaints: errors, warnings, and other requests.
export const newPage = async (options, mayAsk) => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    // Software rendering is slow to read back, and says so.
    const known = /GPU stall due to ReadPixels|Canvas2D: Multiple readback/.test(message.text());
    if (["error", "warning"].includes(message.type()) && !known) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!mayAsk(request.url())) complaints.push(`request of ${request.url()}`);
  });
  return { page, context, complaints };
};

export const axe = async (page, what) => {
  await page.evaluate(axeText);
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  check(violations.length === 0, `${what}: axe finds nothing`,
    violations.map((v) => `${v.id} (${v.nodes.length}): ${v.nodes[0].html.slice(0, 160)}`).join("\n      "));
};

export const screenshot = async (page, folder, name) => {
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`) });
};

export const end = async () => {
  await browser.close();
  console.log(faults === 0 ? "all well" : `${faults} faults`);
  process.exit(faults === 0 ? 0 : 1);
};
