// SPDX-License-Identifier: Apache-2.0
// node check_live.mjs ADDRESS EXPECTED.json [FOLDER]: the page of `console --serve` in headless Chromium
// (tests/cli/live_browser.py serves and writes EXPECTED.json). Nothing is timed: each step waits for the page's own
// answer, and the number of requests is bounded. Screenshots go to FOLDER. Exit code as check.mjs.
import { readFileSync } from "node:fs";

import { axe, check, end, newPage, screenshot } from "./browser.mjs";

const [address, expectedFile, folder] = process.argv.slice(2);
const { object, lamp, camera } = JSON.parse(readFileSync(expectedFile, "utf8"));
const origin = new URL(address).origin;

const open = async (options = {}) => {
  const opened = await newPage(options, (url) => url.startsWith(origin));
  const asked = [];
  opened.page.on("request", (request) => {
    if (request.method() === "POST") asked.push(JSON.parse(request.postData()));
  });
  await opened.page.goto(address);
  await drawn(opened.page, 0);
  return { ...opened, asked };
};
// Until a picture of this level or a finer one is there, of the page's present state.
const drawn = (page, level) => page.waitForFunction((least) => globalThis.earthshineLive.level() >= least, level, { timeout: 0 });
const live = (page, what, ...values) => page.evaluate(([name, list]) => globalThis.earthshineLive[name](...list), [what, values]);
const difference = (a, b) => {
  let sum = 0, all = 0;
  a.forEach((value, k) => { sum += Math.abs(value - b[k]); all += Math.abs(value) + Math.abs(b[k]); });
  return sum / all;
};

// Drags from one place to another, shares of the picture, in a few steps.
const drag = async (page, from, to, steps = 4) => {
  const box = await page.locator("#picture").boundingBox();
  const at = ({ u, v }) => [box.x + u * box.width, box.y + v * box.height];
  await page.mouse.move(...at(from));
  await page.mouse.down();
  await page.mouse.move(...at(to), { steps });
  await page.mouse.up();
};
const click = (page, at) => drag(page, at, at, 1);
// A pixel of the object that no handle covers.
const spotOf = async (page) => {
  for (let u = 0.05; u < 1; u += 0.02) {
    for (let v = 0.05; v < 1; v += 0.02) {
      const isFree = Math.hypot(u - 0.5, v - 0.5) > 0.05;
      if (isFree && (await live(page, "objectAt", { u, v })) === object.key && (await live(page, "objectAt", { u: u + 0.02, v })) === object.key) return { u: u + 0.01, v };
    }
  }
  throw new Error("the object is not in the picture");
};
const near = (a, b, off) => a && b && Math.hypot(a.u - b.u, a.v - b.v) <= off;

const checkCamera = async () => {
  const { page, context, complaints, asked } = await open();
  const before = await live(page, "parts");
  const requests = asked.length;
  await drag(page, { u: 0.1, v: 0.9 }, { u: 0.25, v: 0.8 });
  await drawn(page, 0);
  const after = await live(page, "parts");
  check(difference(before, after) > 0.05, "dragging the camera changes the picture", difference(before, after).toPrecision(2));
  const atOnce = asked.slice(requests).filter(({ level }) => level === 0).length;
  // A move of the pointer asks for one picture at most, and the latest alone while one is drawn.
  check(atOnce >= 1 && atOnce <= 4, "four moves of the pointer ask for at most four pictures", atOnce);
  const { level_errors: wanted } = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent));
  const errors = [];
  for (const level of [1, 2, wanted.length]) {
    await drawn(page, level);
    errors.push({ level: await live(page, "level"), ...(await live(page, "error")) });
  }
  check(errors.every(({ level, bound_95 }) => bound_95 <= wanted[level - 1]), "each level states an error below the wanted one");
  check(errors.at(-1).level === wanted.length && errors.at(-1).estimate < errors[0].estimate, "the stated error falls while nothing moves", errors.map(({ estimate }) => estimate.toPrecision(2)).join(", "));
  check(/error [\d.]+ %/.test(await page.locator("#stamp").textContent()), "the page states it", await page.locator("#stamp").textContent());
  await page.keyboard.press("0");
  await drawn(page, 0);
  check(!asked.at(-1).view && Object.keys(asked.at(-1).set).length === 0, "0 puts all back");
  // The picture at once is coarse, and the light is solved meanwhile: the same within a tenth.
  const back = difference(before, await live(page, "parts"));
  check(back < 0.1 && back < difference(before, after), "and the picture with it", back.toPrecision(2));
  check(complaints.length === 0, "camera: no error, no other request", complaints.join("; "));
  await context.close();
};

const checkHandles = async () => {
  const { page, context, complaints } = await open();
  // An object: a click selects it, a drag moves it in the plane parallel to the picture, so that its point stays under
  // the pointer and its distance along the camera's axis does not change.
  const start = await spotOf(page), middle = await live(page, "place", object.key);
  const { depth } = await live(page, "pixelAt", start);
  await click(page, start);
  check((await live(page, "selected")) === object.key, "a click selects the object under it", await live(page, "selected"));
  const to = { u: start.u + 0.2, v: start.v - 0.15 };
  await drag(page, start, to);
  await drawn(page, 0);
  const end = await live(page, "place", object.key), nearer = depth / middle.depth;
  const wanted = { u: middle.u + 0.2 * nearer, v: middle.v - 0.15 * nearer };
  check(near(end, wanted, 0.01), "its middle moves as the drag says", JSON.stringify({ end, wanted }));
  check(await live(page, "objectAt", to) === object.key, "it is drawn under the pointer");
  check(await live(page, "objectAt", start) !== object.key, "and no longer at its old place");
  check(Math.abs(end.depth / middle.depth - 1) < 1e-3, "its distance along the camera's axis stays", `${middle.depth} ${end.depth}`);
  const value = (await live(page, "set"))[object.key];
  const shown = await page.locator("#move input").evaluateAll((list) => list.map((one) => Number(one.value)));
  check(shown.length === 3 && shown.every((number, k) => Math.abs(number - value[k]) < 1e-3), "the number fields follow", JSON.stringify({ value, shown }));
  // The keyboard.
  await page.locator("#picture").focus();
  await page.keyboard.press("ArrowLeft");
  await drawn(page, 0);
  check((await live(page, "place", object.key)).u < end.u - 0.005, "an arrow key moves it");
  await page.keyboard.press("Shift+ArrowUp");
  await drawn(page, 0);
  check((await live(page, "place", object.key)).depth > 1.005 * middle.depth, "Shift and an arrow key move it away");
  await page.keyboard.press("Escape");
  check((await live(page, "selected")) === "camera", "Escape selects the camera");
  // A lamp, by its ring.
  const ring = await live(page, "place", lamp.key);
  await drag(page, ring, { u: ring.u, v: ring.v + 0.1 });
  await drawn(page, 0);
  check(near(await live(page, "place", lamp.key), { u: ring.u, v: ring.v + 0.1 }, 0.02), "a lamp is dragged by its ring");
  check(JSON.stringify((await live(page, "set"))[lamp.key]) !== JSON.stringify(lamp.value), "and its position changes");
  await page.keyboard.press("Escape");
  // The aim, by its cross in the middle.
  const { look_at } = camera;
  await drag(page, { u: 0.5, v: 0.5 }, { u: 0.6, v: 0.5 });
  await drawn(page, 0);
  const view = await live(page, "view");
  check(JSON.stringify(view.position) === JSON.stringify(camera.position) && JSON.stringify(view.look_at) !== JSON.stringify(look_at),
    "dragging the cross turns the camera on its place");
  check(complaints.length === 0, "handles: no error, no other request", complaints.join("; "));
  await context.close();
};

const checkLooks = async (name, options) => {
  const { page, context, complaints } = await open(options);
  await click(page, await spotOf(page));
  await drawn(page, 1);
  await axe(page, name);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(wide <= 0, `${name}: nothing sticks out`, `${wide} px`);
  await screenshot(page, folder, `live-${name}`);
  check(complaints.length === 0, `${name}: no error, no other request`, complaints.join("; "));
  await context.close();
};

const checkToken = async () => {
  const { page, context } = await newPage({}, () => true);
  const response = await page.goto(`${origin}/?token=${"0".repeat(32)}`);
  check(response.status() === 403, "another token is refused", response.status());
  await context.close();
};

await checkToken();
await checkCamera();
await checkHandles();
await checkLooks("dark", { colorScheme: "dark" });
await checkLooks("light", { colorScheme: "light" });
await checkLooks("tablet", { colorScheme: "light", viewport: { width: 820, height: 1180 }, hasTouch: true });
await end();
