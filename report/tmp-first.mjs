import { pathToFileURL } from "node:url";
const { chromium } = await import("playwright-core");
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });
for (const folder of process.argv.slice(2)) {
const page = await (await browser.newContext()).newPage();
await page.goto(pathToFileURL(folder + "/report.html").href);
  await page.evaluate(() => {
    const sections = [...document.querySelectorAll("main > section")];
    for (const section of sections.slice(sections.findIndex(({ id }) => id === "summary") + 1)) section.remove();
  });
const pdf = await page.pdf({ preferCSSPageSize: true });
console.log(folder, pdf.toString("latin1").match(/\/Type\s*\/Page\b/g).length);
}
await browser.close();
