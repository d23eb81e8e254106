// SPDX-License-Identifier: Apache-2.0
// node check.mjs REPORT.html PLAIN.html FEW.html MANY.html TWO.html HOSTILE.html [FOLDER]: opens the pages in headless Chromium as a reader
// would, by keyboard too, and puts screenshots and a PDF into FOLDER.
// Exit code 0 all well, 1 something is wrong, 77 there is no browser or no node_modules.
import { existsSync, mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const skip = (why) => {
  console.log(`skipped: ${why}`);
  process.exit(77);
};

// Ubuntu's packages of that name only fetch a snap.
const browserPath = ["/usr/bin/chromium", "/usr/bin/google-chrome"].find((path) => existsSync(path));
if (!browserPath) skip("no Chromium at /usr/bin/chromium");
let chromium;
try {
  ({ chromium } = await import("playwright-core"));
} catch {
  skip("playwright-core is not in report/node_modules");
}
const axePath = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

const [page_file, plain_file, few_file, many_file, two_file, hostile_file, folder] = process.argv.slice(2);
if (folder) mkdirSync(folder, { recursive: true });
const kept = (name) => (folder ? join(folder, name) : undefined);
let faults = 0;
const check = (holds, what, found = "") => {
  console.log(`${holds ? "ok   " : "FAULT"} ${what}${holds || found === "" ? "" : `: ${found}`}`);
  if (!holds) ++faults;
};

const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });

// A page that counts what it should never do.
const open = async (file, options = {}) => {
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, ...options });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (!/^(file|data):/.test(request.url())) complaints.push(`request of ${request.url()}`);
  });
  await page.goto(pathToFileURL(resolve(file)).href);
  return { page, context, complaints };
};

const axe = async (page, what) => {
  // By the browser's own protocol: the page's policy lets no other script in.
  await page.evaluate(await readAxe());
  // What passes is not listed: axe would work out a selector for each element of it.
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  const said = violations.map((v) => `${v.id} (${v.nodes.length}): ${v.nodes[0].html.slice(0, 160)}`);
  check(violations.length === 0, `${what}: axe finds nothing`, said.join("\n      "));
};
let axeText;
const readAxe = async () => {
  axeText ??= (await import("node:fs/promises")).readFile(axePath, "utf8");
  return axeText;
};

const picture = async (page, name, fullPage) => folder && page.screenshot({ path: kept(name), fullPage });
const wholePage = (page, name) => picture(page, name, true);

// Everything drawn, as for paper, so that screenshots show it.
const drawAll = (page) => page.evaluate(() => dispatchEvent(new Event("beforeprint")));
const asBefore = (page) => page.evaluate(() => dispatchEvent(new Event("afterprint")));

const focused = (page, of) => page.evaluate(of);

const checkKeyboard = async (page) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("Tab");
  check(await focused(page, () => document.activeElement.matches(".skip")), "the skip link is first");
  await page.keyboard.press("Enter");
  check(await focused(page, () => document.activeElement.id === "content"), "it skips to the content");

  // From here on each Tab goes further down the page, and what has the focus can be seen.
  const stops = [];
  for (let k = 0; k < 40; ++k) {
    await page.keyboard.press("Tab");
    stops.push(
      await page.evaluate(() => {
        const all = [...document.querySelectorAll("*")];
        const at = document.activeElement;
        const { outlineStyle } = getComputedStyle(at);
        return { place: all.indexOf(at), shown: at.checkVisibility() && outlineStyle !== "none", tag: at.outerHTML.slice(0, 80) };
      }),
    );
  }
  const places = stops.map(({ place }) => place);
  check(places.every((place, k) => k === 0 || place > places[k - 1]), "Tab goes down the page", places);
  const unseen = stops.find(({ shown }) => !shown);
  check(!unseen, "what has the focus is outlined", unseen?.tag);

  const heading = page.locator("table.matrix th[data-key=target] button").first();
  await heading.focus();
  await page.keyboard.press("Enter");
  const order = () =>
    page.evaluate(() => {
      const table = document.querySelector("table.matrix");
      return {
        sort: table.querySelector("th[data-key=target]").getAttribute("aria-sort"),
        names: [...table.tBodies[0].rows].map((row) => row.cells[1].textContent),
      };
    });
  const up = await order();
  await page.keyboard.press("Enter");
  const down = await order();
  const sorted = [...up.names].sort();
  check(up.sort === "ascending" && String(up.names) === String(sorted), "Enter sorts upward", up.names);
  check(
    down.sort === "descending" && String(down.names) === String(sorted.reverse()),
    "Enter once more sorts downward",
    down.names,
  );

  await page.locator("table.matrix td[tabindex='0']").first().focus();
  const reading = () => page.locator(".reading").first().textContent();
  const first = await reading();
  await page.keyboard.press("ArrowRight");
  const second = await reading();
  check(/^Camera /.test(first) && first !== second, "arrow keys read the matrix", `${first} | ${second}`);
  // The first brings the panel into view where it is not.
  await page.keyboard.press("Enter");
  if (await focused(page, () => document.activeElement.matches("td"))) await page.keyboard.press("Enter");
  check(
    await focused(page, () => document.activeElement.matches("tr[id]") && document.activeElement.checkVisibility()),
    "Enter goes to the cell's row",
  );

  const failing = page.locator("table.matrix td.v4[data-p]").first();
  await failing.click();
  const panel = failing.locator("xpath=ancestor::*[@data-lamps]/following-sibling::*[1]");
  // On a busy machine the row that was jumped to may still be scrolling under the pointer.
  await panel.locator("p", { hasText: /Not seen\. \S/ }).first().waitFor({ timeout: 5000 }).catch(() => failing.click());
  const shown = await panel.locator("img").count();
  const told = await panel.locator("p").first().textContent();
  check(shown === 2 && /Not seen\. \S/.test(told), "a failing cell shows picture, monitor and reason", `${shown} ${told}`);

  const slider = page.locator("img-comparison-slider").first();
  await slider.focus();
  const value = () => slider.evaluate((element) => Number(element.getAttribute("aria-valuenow")));
  const middle = await value();
  await page.keyboard.down("ArrowRight");
  await page.waitForTimeout(300);
  await page.keyboard.up("ArrowRight");
  const right = await value();
  await page.keyboard.press("Home");
  const home = await value();
  check(right > middle && home === 0, "the slider moves by keyboard", [middle, right, home]);
  await slider.evaluate((element) => { element.value = 50; });
};

const checkFilter = async (page) => {
  const rows = () => page.locator("table.matrix tbody tr:visible").count();
  const all = await rows();
  await page.getByLabel("Camera", { exact: true }).selectOption({ index: 1 });
  const some = await rows();
  await page.getByRole("button", { name: "Show all" }).click();
  check(some > 0 && some < all && (await rows()) === all, "a filter hides rows, Show all brings them back");
};

const pagesOf = (pdf) => pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length;

// What a manager reads: without what follows the summary's first table there is one page.
const checkFirstPage = async () => {
  const { page, context } = await open(page_file);
  await page.evaluate(() => {
    const sections = [...document.querySelectorAll("main > section")];
    for (const section of sections.slice(sections.findIndex(({ id }) => id === "summary") + 1)) section.remove();
    const first = document.querySelector("#summary .scroll");
    while (first.nextElementSibling) first.nextElementSibling.remove();
  });
  const pages = pagesOf(await page.pdf({ preferCSSPageSize: true }));
  check(pages === 1, "all up to the summary's first table prints on page one", pages);
  await context.close();
};

const checkPage = async () => {
  const { page, context, complaints } = await open(page_file);
  const undrawn = ".timeline:has(.charts):not(:has(svg[role=img]))";
  const all = await page.waitForFunction((what) => !document.querySelector(what), undrawn, { timeout: 10000 }).catch(() => null);
  check(all !== null, "each timeline is drawn without scrolling");
  await drawAll(page);
  const figures = await page.locator(".timeline:has(.charts)").count();
  const drawn = await page.locator(".timeline:has(.charts svg[role=img])").count();
  check(figures > 0 && drawn === figures, "each timeline is drawn", `${drawn} of ${figures}`);
  check((await page.locator("img-comparison-slider").count()) > 0, "pairs have sliders");
  await page.waitForTimeout(300);
  await wholePage(page, "report-open.png");
  await axe(page, "all open");
  await asBefore(page);
  await wholePage(page, "report-wide.png");
  await checkKeyboard(page);
  await checkFilter(page);
  const pdf = await page.pdf({ path: kept("report.pdf"), preferCSSPageSize: true });
  check(pdf.length > 20000, "it prints");
  check(pagesOf(pdf) <= 9, "on at most 9 pages", pagesOf(pdf));
  const rows = await page.evaluate(() => {
    for (const details of document.querySelectorAll("#figures details")) details.open = true;
    return Math.max(...[...document.querySelectorAll("#figures tbody tr")].map((row) => row.offsetHeight));
  });
  check(rows <= 150, "no row of all figures is higher than 150 px", rows);
  await page.emulateMedia({ media: "print" });
  await drawAll(page);
  await wholePage(page, "report-print.png");
  const printed = await page.evaluate(() =>
    [...document.querySelectorAll("#pictures img")].filter((image) => !image.closest(".thumbs") && image.checkVisibility()).map(({ src }) => src));
  check(printed.length === 3 && new Set(printed).size === 3, "each picture is printed once", printed.length);
  check(complaints.length === 0, "no error, no request", complaints.join("; "));
  await context.close();
};

const checkLooks = async (name, options) => {
  const { page, context, complaints } = await open(page_file, options);
  await drawAll(page);
  await asBefore(page);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(overflow <= 0, `${name}: nothing sticks out`, `${overflow} px`);
  await axe(page, name);
  await wholePage(page, `report-${name}.png`);
  check(complaints.length === 0, `${name}: no error, no request`, complaints.join("; "));
  await context.close();
};

// Summary, a page for each of at most three targets, one of pictures, provenance.
const checkSmallPrints = async () => {
  for (const file of [few_file, many_file, two_file]) {
    const { page, context } = await open(file);
    const pages = pagesOf(await page.pdf({ path: kept(`${file.split("/").pop()}.pdf`), preferCSSPageSize: true }));
    check(pages <= 6, "a report of at most 100 results prints on at most 6 pages", `${file}: ${pages}`);
    await page.emulateMedia({ media: "print" });
    await drawAll(page);
    const missing = await page.evaluate(() => {
      const failing = [...document.querySelectorAll("table.matrix td.v4, table.matrix td.v6")].filter(({ dataset }) => dataset.p);
      return failing.filter(({ dataset }) => !document.getElementById(`p${dataset.p}`).checkVisibility()).length;
    });
    check(missing === 0, "the picture of each failing condition is printed", missing);
    await context.close();
  }
};

const checkExposures = async () => {
  const { page, context } = await open(page_file);
  const slider = page.locator("img-comparison-slider img").first();
  const own = await slider.getAttribute("src");
  await page.getByRole("button", { name: "Show pairs side by side" }).click();
  check(await page.locator(".twice img.own").first().isVisible(), "each picture is shown by its own exposure");
  await page.getByRole("button", { name: "Same exposure" }).click();
  const same = await page.locator(".twice img.same").first().isVisible();
  const left = await page.locator(".twice img.own").first().isVisible();
  check(same && !left && (await slider.getAttribute("src")) !== own, "one button shows all by the same exposure", [same, left]);
  await context.close();
};

const checkScenes = async () => {
  const { page, context } = await open(two_file);
  const rows = () => page.locator("table.matrix tbody tr:visible, .ledger tbody tr:visible, .timeline:visible").count();
  const all = await rows();
  await page.getByLabel("Scene", { exact: true }).selectOption("open doors");
  const some = await rows();
  check(2 * some === all, "a choice of scene leaves the half that is of it", [some, all]);
  await context.close();
};

const checkPhone = async () => {
  const { page, context } = await open(page_file, { viewport: { width: 390, height: 844 } });
  const wide = await page.evaluate(() => {
    for (const details of document.querySelectorAll("details")) details.open = true;
    const holders = [...document.querySelectorAll(".scroll")].filter((holder) => holder.scrollWidth > holder.clientWidth);
    for (const details of document.querySelectorAll("main > section > details")) details.open = false;
    return holders.map((holder) => holder.getAttribute("aria-label"));
  });
  check(wide.length === 0, "each table fits a phone", wide);
  await picture(page, "report-phone.png", false);
  const heights = await page.evaluate(() =>
    [...document.querySelectorAll("main > section")].map(({ id, offsetHeight }) => [id, offsetHeight]));
  const long = heights.filter(([, height]) => height > 3000);
  check(heights.length > 5 && long.length === 0, "no section is longer than 3000 px on a phone", long);
  await context.close();
};

const checkPlain = async () => {
  const { page, context, complaints } = await open(plain_file);
  check((await page.locator("script").count()) === 0, "the plain page has no script");
  await axe(page, "plain");
  await wholePage(page, "report-plain.png");
  check(complaints.length === 0, "plain: no error, no request", complaints.join("; "));
  await context.close();
};

// Names that would run, turn or widen the page (tests/cli/report_browser.py).
const checkHostile = async () => {
  for (const width of [400, 1280]) {
    const { page, context, complaints } = await open(hostile_file, { viewport: { width, height: 800 } });
    await drawAll(page);
    await asBefore(page);
    const found = await page.evaluate(() => ({
      owned: "owned" in window,
      foreign: document.querySelectorAll("[onload], [onerror], img[src='x'], svg[onload]").length,
      sections: [...document.querySelectorAll("main > section")].filter((section) => section.checkVisibility()).length,
      overflow: document.documentElement.scrollWidth - innerWidth,
    }));
    check(!found.owned && found.foreign === 0, `hostile names, ${width} px: nothing runs`, JSON.stringify(found));
    check(found.sections > 5, `hostile names, ${width} px: all sections are shown`, found.sections);
    check(found.overflow <= 0, `hostile names, ${width} px: nothing sticks out`, `${found.overflow} px`);
    await picture(page, `report-hostile-${width}.png`, false);
    check(complaints.length === 0, `hostile names, ${width} px: no error, no request`, complaints.join("; "));
    await context.close();
  }
};

await checkPage();
await checkFirstPage();
await checkLooks("narrow", { viewport: { width: 400, height: 800 } });
await checkLooks("dark", { colorScheme: "dark" });
await checkSmallPrints();
await checkExposures();
await checkScenes();
await checkPhone();
await checkPlain();
await checkHostile();
await browser.close();
console.log(faults === 0 ? "all well" : `${faults} faults`);
process.exit(faults === 0 ? 0 : 1);
