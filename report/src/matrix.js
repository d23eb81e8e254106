// SPDX-License-Identifier: Apache-2.0
// The matrix as a grid: one tab stop, arrow keys go from cell to cell, and a line below says what
// the cell stands for, with the figures of its row in "All figures".

const cellsOf = (row) => [...row.cells].filter((cell) => !cell.matches("th, .n"));

const shownRows = (table) => [...table.tBodies[0].rows].filter((row) => !row.hidden);

// Verdict and reason of a cell, and all its other figures.
const describe = (table, cell) => {
  const row = cell.parentElement;
  const heading = table.tHead.rows[table.tHead.rows.length - 1].cells[cell.cellIndex];
  const place = heading.textContent.trim();
  const [camera, target] = [row.cells[0].textContent, row.cells[1].textContent];
  const text = `Camera ${camera}, ${target}, ${place}: ${cell.textContent.trim()}.`;
  const figures = document.getElementById(`r${cell.dataset.r}`);
  if (!figures) return [text, ""];
  const titles = figures.closest("table").tHead.rows[0].cells;
  const told = [];
  let reason = "";
  for (let k = 4; k < figures.cells.length; ++k) {
    const value = figures.cells[k].textContent.trim();
    if (value === "–") continue;
    const title = titles[k].textContent;
    if (title === "decided by" || title === "why not") reason += ` ${value[0].toUpperCase()}${value.slice(1)}.`;
    else told.push(`${title}: ${value};`);
  }
  return [text + reason, told.join(" ").replace(/;$/, ".")];
};

// The small picture that goes with a cell, clean and on the monitor, with the place it is of.
const showPictures = (table, cell, into) => {
  into.replaceChildren();
  const figure = document.getElementById(`p${cell.dataset.p}`);
  if (!figure) return;
  for (const image of figure.querySelectorAll("img")) into.append(image.cloneNode());
  const caption = document.createElement("p");
  const same = [...cell.parentElement.cells].find((other) => other.dataset.p === cell.dataset.p) === cell;
  caption.textContent = same
    ? figure.textContent.trim()
    : `Pictured: ${figure.textContent.trim()}; from there to here no verdict of this camera changes.`;
  into.append(caption);
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

const inView = (element) => {
  const { top, bottom } = element.getBoundingClientRect();
  return top >= 0 && bottom <= innerHeight;
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
  const panel = document.createElement("div");
  panel.className = "reading";
  panel.setAttribute("role", "status");
  const hint = document.createElement("p");
  const shots = document.createElement("div");
  shots.className = "shots";
  const figures = document.createElement("p");
  panel.append(hint, shots, figures);
  hint.textContent =
    "Choose a cell for its picture, its reason and its figures; the arrow keys move, Enter goes to its row.";
  table.closest(".scroll").after(panel);
  const read = (cell) => {
    [hint.textContent, figures.textContent] = describe(table, cell);
    showPictures(table, cell, shots);
  };
  let current = null;
  let looked = null; // the cell whose panel has been brought into view
  const choose = (cell, focus) => {
    if (current) current.tabIndex = -1;
    current = cell;
    cell.tabIndex = 0;
    if (focus) cell.focus();
    else return;
    read(cell);
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
    if (cell) read(cell);
  });
  table.addEventListener("keydown", (event) => {
    const cell = chosen(event);
    if (!cell) return;
    if (event.key === "Enter") {
      // What is seen and why, first; once more, and the row of all its figures.
      if (cell.dataset.p && looked !== cell && !inView(panel)) panel.scrollIntoView({ block: "nearest" });
      else goToRow(cell);
      looked = cell;
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
