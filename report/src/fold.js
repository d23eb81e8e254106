// SPDX-License-Identifier: Apache-2.0
// On a phone a long section is folded: what is below it stays within reach.

const narrow = "(max-width: 40rem)";
const longest = 2400; // CSS pixels

export const foldLongSections = () => {
  if (!matchMedia(narrow).matches) return;
  for (const section of document.querySelectorAll("main > section")) {
    if (section.offsetHeight <= longest) continue;
    const fold = document.createElement("details");
    const summary = document.createElement("summary");
    const [heading, ...content] = section.children;
    summary.textContent = `Show “${heading.textContent}”`;
    fold.append(summary, ...content);
    section.append(fold);
  }
};
