import { pathToFileURL } from "node:url";
import { readFileSync } from "node:fs";
const { chromium } = await import("playwright-core");
const [folder, out] = process.argv.slice(2);
const study = JSON.parse(readFileSync(folder + "/study.json"));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
const page = await context.newPage();
page.on("console", (m) => console.log("console", m.type(), m.text()));
const t0 = Date.now();
await page.goto(pathToFileURL(folder + "/report.html").href);
console.log("opened", Date.now() - t0, "ms; title", await page.title());
await page.waitForTimeout(1500);
await page.screenshot({ path: out + "/top.png" });
await page.screenshot({ path: out + "/full.png", fullPage: true });
const cells = await page.locator("table.matrix td[data-r]").count();
const info = await page.evaluate(() => [...document.querySelectorAll("table.matrix td[data-r]")].map((c, k) => [k, c.className, c.textContent.trim(), c.dataset.r, c.dataset.p]));
const failing = info.filter(([, cls]) => !/v[012]\b/.test(cls));
console.log("cells", cells, "failing", failing.length, JSON.stringify([...new Set(failing.map((f) => f[1] + ":" + f[2]))]));
const res = await page.evaluate(() => {
  const out = [];
  for (const cell of document.querySelectorAll("table.matrix td[data-r]")) {
    if (/v[012]\b/.test(cell.className)) continue;
    cell.click();
    const panel = cell.closest(".scroll").nextElementSibling;
    const imgs = panel.querySelectorAll("img").length;
    const ps = [...panel.querySelectorAll("p")].map((p) => p.textContent);
    out.push([imgs, ps[0], ps[1]]);
  }
  return out;
});
const kinds = {};
for (const [imgs, p0, p1] of res) { const key = imgs + " images, reason " + /\. \S/.test(p0); kinds[key] = (kinds[key] ?? 0) + 1; }
console.log(kinds);
for (const k of [0, Math.floor(res.length / 3), Math.floor(res.length / 2), res.length - 1]) if (res[k]) console.log(res[k]);
// every failing result's reason is in the panels
const why = study.results.filter((r) => !["identified", "recognised", "detected"].includes(r.verdict)).map((r) => r.why);
console.log("failing results", why.length, "without a reason", why.filter((w) => !w).length);
const shown = res.map((r) => r[1].toLowerCase());
console.log("reasons not shown in any panel:", why.filter((w) => w && !shown.some((s) => s.includes(w.toLowerCase()))).slice(0, 3));
// click one by mouse, screenshot
const one = page.locator("table.matrix td.v4[data-r]").first();
if (await one.count()) { await one.scrollIntoViewIfNeeded(); await one.click(); await page.waitForTimeout(300); await page.keyboard.press("Enter"); await page.waitForTimeout(500); await page.screenshot({ path: out + "/cell.png" }); await page.keyboard.press("Enter"); await page.waitForTimeout(800); console.log("after Enter:", await page.evaluate(() => document.activeElement.tagName + " " + document.activeElement.id + " " + document.activeElement.textContent.slice(0, 200))); await page.screenshot({ path: out + "/row.png" }); }
const pdf = await page.pdf({ path: out + "/report.pdf", preferCSSPageSize: true });
console.log("pdf pages", pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length, "bytes", pdf.length);
await context.close();
const phone = await browser.newContext({ viewport: { width: 390, height: 844 } });
const p = await phone.newPage();
await p.goto(pathToFileURL(folder + "/report.html").href);
await p.waitForTimeout(800);
console.log(JSON.stringify(await p.evaluate(() => [...document.querySelectorAll("main > section")].map(({ id, offsetHeight }) => [id, offsetHeight]))));
console.log("overflow", await p.evaluate(() => document.documentElement.scrollWidth - innerWidth));
await p.screenshot({ path: out + "/phone.png" });
await p.screenshot({ path: out + "/phone-full.png", fullPage: true });
await browser.close();
