// SPDX-License-Identifier: Apache-2.0
// node check.mjs PAGE.html EXPECTED.json [FOLDER]: opens a console's page in headless Chromium and compares its
// pictures with the program's (tests/cli/console_browser.py writes EXPECTED.json); keyboard, link, undo, axe.
// Screenshots go to FOLDER. Exit code 0 all well, 1 something is wrong, 77 there is no browser or no node_modules.
import { readFileSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { axe, check, end, newPage, screenshot } from "./browser.mjs";

const [pageFile, expectedFile, folder] = process.argv.slice(2);
const expected = JSON.parse(readFileSync(expectedFile, "utf8"));
const open = async ({ fragment = "", withoutGpu = false, file = pageFile, ...options } = {}) => {
  const { page, context, complaints } = await newPage(options, (url) => /^(file|data|blob):/.test(url));
  if (withoutGpu) {
    await page.addInitScript(() => {
      const real = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
        return kind === "webgl2" ? null : real.call(this, kind, ...more);
      };
    });
  }
  await page.goto(`${pathToFileURL(resolve(file)).href}${fragment ? `#${fragment}` : ""}`);
  await page.waitForFunction(() => /ms$/.test(document.getElementById("stamp").textContent));
  return { page, context, complaints };
};
const settled = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
const fragmentOf = (page) => page.evaluate(() => location.hash.slice(1));

// In the page. Shares of the bytes that are those of a PNG, and off by at most one.
const inPage = `globalThis.compareBytes = async (found, png) => {
  const data = Uint8Array.from(atob(png), (letter) => letter.charCodeAt(0));
  const bitmap = await createImageBitmap(new Blob([data], { type: "image/png" }), { colorSpaceConversion: "none" });
  if (bitmap.width !== found.columns || bitmap.height !== found.rows) return { near: 0, worst: 255 };
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height), context = canvas.getContext("2d");
  context.drawImage(bitmap, 0, 0);
  const wanted = context.getImageData(0, 0, bitmap.width, bitmap.height).data;
  let equal = 0, near = 0, worst = 0;
  for (let i = 0; i < wanted.length; ++i) {
    const difference = Math.abs(found.bytes[i] - wanted[i]);
    if (difference === 0) ++equal;
    if (difference <= 1) ++near;
    worst = Math.max(worst, difference);
  }
  return { equal: equal / wanted.length, near: near / wanted.length, worst };
};
// A half float is within 2^-11 of its value, and layers add up: 1e-3 of the sum, or half a grey level in the dark,
// where the sRGB curve has the slope 12.92. As a share of what is allowed.
globalThis.worstOf = (found, wanted) => {
  const dark = 0.5 / 255 / 12.92 / found.tone.exposure;
  let worst = 0;
  wanted.forEach((plane, c) => plane.forEach((value, i) => {
    worst = Math.max(worst, Math.abs(found.sums[c][i] - value) / Math.max(1e-3 * Math.abs(value), dark));
  }));
  return worst;
};`;

const checkClean = async (page, useGpu) => {
  for (const one of expected.clean) {
    const { byCard, share, worst } = await page.evaluate(async ([{ text, sums, png }, gpu]) => {
      const found = await globalThis.earthshineConsole.clean(text, gpu);
      return { byCard: found.byCard, share: await globalThis.compareBytes(found, png), worst: globalThis.worstOf(found, sums) };
    }, [one, useGpu]);
    const what = `clean ${one.text} by ${byCard ? "WebGL2" : "2D"}`;
    check(byCard === useGpu && share.worst <= 1, `${what}: bytes within one grey level`, JSON.stringify(share));
    if (!useGpu) check(worst <= 1, `${what}: sums within 1e-3 or half a grey level`, `${worst.toPrecision(2)} of that`);
  }
};

const checkMonitor = async (page) => {
  for (const one of expected.monitor) {
    const { share, fNumber } = await page.evaluate(async ({ text, png }) => {
      const found = await globalThis.earthshineConsole.monitor(text);
      return { share: await globalThis.compareBytes(found, png), fNumber: found.exposure.fNumber };
    }, one);
    check(share.near >= 0.999, `monitor ${one.text}: within one grey level at 99.9 %`,
      `${JSON.stringify(share)}, f/${fNumber.toPrecision(5)} for f/${one.f_number.toPrecision(5)}`);
  }
};

// A cause of the study that cures alone is in the page's words, with its probability; those that need the scene's
// geometry are not the page's. At a contrast of 1 % the half floats change the difference by a tenth, and a probability
// by up to 0.05.
const causeWords = {
  saturated: "saturated", lag: "tube's lag", blur: "blurred by", noise: "lost in noise", "room-light": "room's light",
  contrast: "too little contrast", small: "too small",
};
const checkReasons = async (page, cases) => {
  let agree = 0, differ = 0;
  for (const { text, targets } of cases.filter((one) => one.targets.some(({ reasons }) => reasons.length > 0))) {
    const found = new Map(await page.evaluate((state) => globalThis.earthshineConsole.reasons(state), text));
    for (const { name, reasons, weber } of targets) {
      for (const { cause, by, probability_without: p, text: reason } of reasons) {
        const unlit = cause === "unlit" && /(switched off|dimmed)/.exec(reason);
        const words = unlit ? `${by} ${unlit[0]}` : causeWords[cause];
        if (!words || !(p >= 0.52) || (cause === "contrast" && Math.abs(weber) < 0.02)) continue;
        const said = found.get(name).split("; ").filter((part, k, all) => part.includes(words) || all[k - 1]?.includes(words));
        const isThere = said.some((part) => Math.abs(Number(/(\d\.\d+)$/.exec(part)?.[1]) - p) <= 0.05);
        if (isThere) ++agree;
        else ++differ;
        if (!isThere) console.log(`      ${text} ${name}: ${reason}, the page says ${found.get(name)}`);
      }
    }
  }
  if (agree + differ > 0) check(differ === 0 && agree > 10, "reasons: the study's causes that cure alone, with their probability", `${agree} of ${agree + differ}`);
};

// The page's sums are of half floats: a mean is off by at most 2^-11, so that a contrast C is off by 2^-10 (1 + |C|).
// A verdict may differ only where a probability is within what such a contrast changes it by, and that is said.
const checkVerdicts = async ({ page: file, cases }) => {
  const { page, context } = await open({ file });
  const counts = {}, worst = { luminance: 0, weber: 0, snr: 0, snr_d: 0, chance: 0 };
  let settings = 0, near = 0, wrong = 0;
  for (const { text, targets } of cases) {
    const found = await page.evaluate((state) => globalThis.earthshineConsole.targets(state), text);
    ++settings;
    for (const row of targets) {
      const own = found.find((target) => target.name === row.name);
      counts[row.verdict] = (counts[row.verdict] ?? 0) + 1;
      const off = (value, wanted) => (wanted === null ? 0 : wanted === 0 ? Math.abs(value) : Math.abs(value / wanted - 1));
      if (row.luminance) worst.luminance = Math.max(worst.luminance, off(own.luminance, row.luminance));
      if (row.weber !== null && row.weber !== undefined) worst.weber = Math.max(worst.weber, Math.abs(own.weber - row.weber) / (1 + Math.abs(row.weber)));
      // Below 1 the signal is a difference of small numbers.
      if (row.snr > 1) worst.snr = Math.max(worst.snr, off(own.snr, row.snr));
      if (row.snr_d > 1) worst.snr_d = Math.max(worst.snr_d, off(own.snrD, row.snr_d));
      const distance = row.chances && own.chances ? Math.max(...row.chances.map((p, k) => Math.abs(p - own.chances[k]))) : row.chances || own.chances ? 1 : 0;
      worst.chance = Math.max(worst.chance, distance);
      if (row.chances && !own.chances) console.log(`      ${text} ${row.name}: no probability`);
      if (own.verdict === row.verdict) continue;
      const isNear = distance < 0.02 && row.chances.some((p) => [0.1, 0.5].some((threshold) => Math.abs(p - threshold) < 0.02));
      if (isNear) ++near;
      else ++wrong;
      console.log(`${isNear ? "near " : "FAULT"} ${row.name} ${text}: ${own.verdict} for ${row.verdict}, ${own.chances} for ${row.chances}`);
    }
  }
  await checkReasons(page, cases);
  check(wrong === 0 && worst.luminance < 0.01 && worst.chance < 0.02, `verdicts of the study at ${settings} settings`, `${JSON.stringify(counts)}, ${near} within rounding of a threshold; worst ${JSON.stringify(worst)}`);
  await context.close();
};

const checkUse = async () => {
  const { page, context, complaints } = await open();
  const fader = page.locator(".strip:not(.master) .fader").first();
  await fader.focus();
  await page.keyboard.press("Home");
  await settled(page);
  const dark = await fragmentOf(page);
  check(/(^|&)l\.[^=]+=0(&|$)/.test(dark), "Home on a fader turns its light off", dark);
  await page.keyboard.press("z");
  await settled(page);
  check(!/l\./.test(await fragmentOf(page)), "z undoes it");
  await page.keyboard.press("Z");
  await settled(page);
  check((await fragmentOf(page)) === dark, "Z redoes it");
  await page.keyboard.press("o");
  await settled(page);
  check(/off\./.test(await fragmentOf(page)), "o switches the light of the fader");
  for (const [key, part] of [["m", "view=monitor"], ["f", "top="], ["n", "noise=frozen"], ["i", "c.iris="]]) {
    await page.keyboard.press(key);
    await settled(page);
    check((await fragmentOf(page)).includes(part), `${key} sets ${part}`, await fragmentOf(page));
  }
  if (expected.cameras > 1) {
    await page.keyboard.press("2");
    await page.waitForFunction(() => /camera=/.test(location.hash));
    check(!(await fragmentOf(page)).includes("c.iris="), "2 takes the second camera as it is");
  }
  const text = await fragmentOf(page);
  const again = await open({ fragment: text });
  check((await fragmentOf(again.page)) === text, "a link opens the same state", text);
  await again.context.close();
  await page.keyboard.press("k");
  await settled(page);
  check(await page.locator("#line").isVisible(), "k keeps the picture beside the split");
  await page.locator("#picture").focus();
  await page.keyboard.press("ArrowRight");
  check(/cd\/m².*at \d+, \d+/.test(await page.locator("#reading").textContent()), "arrow keys read a pixel");
  await page.keyboard.press("c");
  check(await page.locator("#copies").isVisible(), "c shows link, table and command");
  await axe(page, "copies");
  await page.keyboard.press("Escape");
  check(complaints.length === 0, "no error, no request", complaints.join("; "));
  await context.close();
};

const checkLooks = async (name, options) => {
  const { page, context, complaints } = await open(options);
  await page.mouse.move(300, 300);
  await settled(page);
  await axe(page, name);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(wide <= 0, `${name}: nothing sticks out`, `${wide} px`);
  await screenshot(page, folder, `console-${name}`);
  check(complaints.length === 0, `${name}: no error, no request`, complaints.join("; "));
  await context.close();
};

const checkPictures = async () => {
  const { page, context } = await open();
  await page.evaluate(inPage);
  await checkClean(page, true);
  await checkMonitor(page);
  const words = await page.evaluate((states) => states.map((text) => globalThis.earthshineConsole.words(text)), expected.words);
  if (expected.words_file) writeFileSync(expected.words_file, JSON.stringify(words));
  await context.close();
  const plain = await open({ withoutGpu: true });
  await plain.page.evaluate(inPage);
  await checkClean(plain.page, false);
  check(plain.complaints.length === 0, "without WebGL2: no error", plain.complaints.join("; "));
  await plain.context.close();
};

await checkPictures();
for (const one of expected.verdicts) await checkVerdicts(one);
await checkUse();
await checkLooks("dark", { colorScheme: "dark" });
await checkLooks("light", { colorScheme: "light", fragment: "view=monitor" });
await checkLooks("false-colours", { colorScheme: "dark", fragment: "top=2" });
await checkLooks("study", { colorScheme: "light", file: expected.verdicts[1].page });
await checkLooks("tablet", { colorScheme: "light", viewport: { width: 820, height: 1180 } });
await end();
