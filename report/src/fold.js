// SPDX-License-Identifier: Apache-2.0
// On a phone: a table that does not fit becomes cards, one for each row, and a long section is
// folded, so that the sections below it stay within reach; the first one stays open.

const narrow = matchMedia("(max-width: 40rem)");
const longest = 2400; // CSS pixels

// Each cell gets its heading as a label; page.css shows it where the table is cards.
const label = (table) => {
  const heads = [...(table.tHead?.rows[table.tHead.rows.length - 1].cells ?? [])].map((head) => head.textContent.trim());
  for (const row of table.tBodies[0].rows) {
    [...row.cells].forEach((cell, k) => (cell.dataset.label = heads[k] ?? ""));
  }
};

const makeCards = () => {
  for (const table of document.querySelectorAll(".scroll table")) {
    table.classList.remove("cards");
    const holder = table.closest(".scroll");
    if (!narrow.matches || (holder.offsetParent && holder.scrollWidth <= holder.clientWidth)) continue;
    label(table);
    table.classList.add("cards");
  }
};

const foldLongSections = () => {
  if (!narrow.matches) return;
  for (const section of document.querySelectorAll("main > section")) {
    if (section.id === "short" || section.offsetHeight <= longest) continue;
    const fold = document.createElement("details");
    const summary = document.createElement("summary");
    const [heading, ...content] = section.children;
    summary.textContent = `Show “${heading.textContent}”`;
    fold.append(summary, ...content);
    section.append(fold);
  }
};

export const fitPhone = () => {
  makeCards();
  narrow.addEventListener("change", makeCards);
  foldLongSections();
  // Tables that are shown, or filled, later.
  addEventListener("load", makeCards);
  document.addEventListener("toggle", () => requestAnimationFrame(makeCards), true);
};
