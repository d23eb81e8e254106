// SPDX-License-Identifier: Apache-2.0
// The matrix as a grid: one tab stop, arrow keys go from cell to cell, and a line below says what
// the cell stands for, with the figures of its row in "All figures".

const cellsOf = (row) => [...row.cells].filter((cell) => !cell.matches("th, .n"));

const shownRows = (table) => [...table.tBodies[0].rows].filter((row) => !row.hidden);

const describe = (table, cell) => {
  const row = cell.parentElement;
  const heading = table.tHead.rows[table.tHead.rows.length - 1].cells[cell.cellIndex];
  const place = heading.textContent.trim();
  const [camera, target] = [row.cells[0].textContent, row.cells[1].textContent];
  const text = `Camera ${camera}, ${target}, ${place}: ${cell.textContent.trim()}.`;
  const figures = document.getElementById(`r${cell.dataset.r}`);
  if (!figures) return text;
  const titles = figures.closest("table").tHead.rows[0].cells;
  const told = [];
  for (let k = 4; k < figures.cells.length; ++k) {
    const value = figures.cells[k].textContent;
    if (value === "–") continue;
    // The reason of this very condition stands before the figures.
    const why = titles[k].textContent === "why not";
    if (why) told.unshift(`${value[0].toUpperCase()}${value.slice(1)}.`);
    else told.push(`${titles[k].textContent}: ${value};`);
  }
  return [text, ...told].join(" ").replace(/;$/, ".");
};

const step = (table, cell, key) => {
  const rows = shownRows(table);
  const row = rows.indexOf(cell.parentElement);
  const cells = cellsOf(cell.parentElement);
  const column = cells.indexOf(cell);
  const within = (list, k) => list[Math.min(Math.max(k, 0), list.length - 1)];
  switch (key) {
    case "ArrowLeft":
      return within(cells, column - 1);
    case "ArrowRight":
      return within(cells, column + 1);
    case "Home":
      return cells[0];
    case "End":
      return cells[cells.length - 1];
    case "ArrowUp":
      return cellsOf(within(rows, row - 1))[column];
    case "ArrowDown":
      return cellsOf(within(rows, row + 1))[column];
    default:
      return null;
  }
};

// Opens what hides the row and goes there.
const goToRow = (cell) => {
  const row = document.getElementById(`r${cell.dataset.r}`);
  if (!row) return;
  for (let at = row.closest("details"); at; at = at.parentElement.closest("details")) at.open = true;
  row.hidden = false;
  row.scrollIntoView({ block: "center" });
  row.tabIndex = -1;
  row.focus();
};

const enhance = (table) => {
  table.setAttribute("role", "grid");
  const hint = document.createElement("p");
  hint.className = "reading";
  hint.setAttribute("role", "status");
  hint.textContent = "Choose a cell for its figures; the arrow keys move, Enter goes to its row.";
  table.closest(".scroll").after(hint);
  let current = null;
  const choose = (cell, focus) => {
    if (current) current.tabIndex = -1;
    current = cell;
    cell.tabIndex = 0;
    if (focus) cell.focus();
    else return;
    hint.textContent = describe(table, cell);
  };
  const first = table.querySelector("tbody td[data-r]");
  if (first) choose(first, false);
  const chosen = (event) => event.target.closest("tbody td:not(.n)");
  table.addEventListener("click", (event) => {
    const cell = chosen(event);
    if (cell) choose(cell, true);
  });
  table.addEventListener("focusin", (event) => {
    const cell = chosen(event);
    if (cell) hint.textContent = describe(table, cell);
  });
  table.addEventListener("keydown", (event) => {
    const cell = chosen(event);
    if (!cell) return;
    if (event.key === "Enter") {
      goToRow(cell);
      event.preventDefault();
      return;
    }
    const next = step(table, cell, event.key);
    if (!next) return;
    choose(next, true);
    event.preventDefault();
  });
};

export const enhanceMatrices = () => {
  for (const table of document.querySelectorAll("table.matrix")) enhance(table);
};
