import { pathToFileURL } from "node:url";
const { chromium } = await import("playwright-core");
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
for (const folder of process.argv.slice(2)) {
const page = await (await browser.newContext({ viewport: { width: 1032, height: 703 } })).newPage();
await page.goto(pathToFileURL(folder.endsWith("html") ? folder : folder + "/report.html").href);
await page.emulateMedia({ media: "print" });
await page.waitForTimeout(500);
console.log(folder, JSON.stringify(await page.evaluate(() => [...document.querySelectorAll("body > *, main > *")].slice(0,14).map((e) => [e.tagName, e.id, e.className, Math.round(e.getBoundingClientRect().top), Math.round(e.getBoundingClientRect().bottom)]).filter((e)=>e[4]>e[3]))));
}
await browser.close();
