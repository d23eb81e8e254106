// SPDX-License-Identifier: Apache-2.0
// Tables sort by a click or Enter on a heading: first upward, then downward.

const words = new Intl.Collator("en", { numeric: true });
const verdicts = [
  "identified",
  "recognised",
  "detected",
  "doubtful",
  "not seen",
  "out of view",
  "hidden",
];

// What a cell sorts by. A value that does not exist is null and stays last either way.
const keyOf = (cell, byVerdict) => {
  const text = cell?.textContent.trim() ?? "";
  if (text === "" || text === "–") return null;
  if (byVerdict) return verdicts.indexOf(text);
  const share = /^(\d+)\/(\d+)$/.exec(text);
  if (share) return Number(share[1]) / Math.max(1, Number(share[2]));
  const number = /^[<>]?\s*(-?[\d.]+(?:e[+-]?\d+)?)\s*[°+]?$/i.exec(text);
  return number ? Number(number[1]) : text;
};

const compare = (a, b) => {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return words.compare(String(a), String(b));
};

const sortBy = (table, heading) => {
  const down = heading.getAttribute("aria-sort") === "ascending";
  const column = heading.cellIndex;
  const byVerdict = heading.dataset.key === "verdict";
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => ({ row, key: keyOf(row.cells[column], byVerdict) }));
  rows.sort((a, b) => {
    if (a.key === null || b.key === null) return (a.key === null) - (b.key === null);
    return down ? compare(b.key, a.key) : compare(a.key, b.key);
  });
  body.append(...rows.map(({ row }) => row));
  for (const other of table.querySelectorAll("th[aria-sort]")) other.removeAttribute("aria-sort");
  heading.setAttribute("aria-sort", down ? "descending" : "ascending");
};

export const enhanceSorting = () => {
  for (const table of document.querySelectorAll("table")) {
    if (!table.tBodies[0] || table.tBodies[0].rows.length < 2) continue;
    const headings = table.tHead.rows[table.tHead.rows.length - 1].cells;
    for (const heading of headings) {
      // The matrix's conditions are columns to read, a tab stop each would be in the way.
      if (heading.classList.contains("place")) continue;
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...heading.childNodes);
      button.addEventListener("click", () => sortBy(table, heading));
      heading.append(button);
    }
  }
};
