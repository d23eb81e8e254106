// SPDX-License-Identifier: Apache-2.0
// One bar of choices for the whole page: scene, camera, target, lamps and verdict.

const names = (values) => [...new Set(values)].filter((value) => value !== "");

const columnOf = (table, key) => {
  const headings = table.tHead?.rows[table.tHead.rows.length - 1].cells ?? [];
  return [...headings].findIndex((heading) => heading.dataset.key === key);
};

const tablesWith = (key) =>
  [...document.querySelectorAll("table.matrix, table.figures, table.ledger")].map((table) => ({
    table,
    column: columnOf(table, key),
  }));

const valuesOf = (key) => {
  const values = [];
  for (const { table, column } of tablesWith(key)) {
    if (column < 0 || (key === "verdict" && !table.matches(".figures"))) continue;
    for (const row of table.tBodies[0].rows) values.push(row.cells[column].textContent);
  }
  return names(values);
};

const apply = (chosen) => {
  const fits = (key, value) => !chosen[key] || value === undefined || chosen[key] === value;
  // Of a part that belongs to one scene or lamp setting.
  const under = ({ dataset }) => fits("scene", dataset.scene || undefined) && fits("lamps", dataset.lamps || undefined);
  for (const table of document.querySelectorAll("table.matrix, table.figures, table.ledger")) {
    const columns = ["camera", "target", "verdict"].map((key) => [key, columnOf(table, key)]);
    let shown = 0;
    for (const row of table.tBodies[0].rows) {
      row.hidden =
        !columns.every(([key, at]) => at < 0 || fits(key, row.cells[at].textContent)) || !under(row);
      if (!row.hidden) ++shown;
    }
    const holder = table.closest(".rows, [data-scene]");
    holder.hidden = shown === 0 || !under(holder);
    const reading = holder.nextElementSibling;
    if (reading?.matches(".reading")) reading.hidden = holder.hidden;
  }
  for (const figure of document.querySelectorAll(".timeline")) {
    figure.hidden = !["camera", "scene", "lamps"].every((key) => fits(key, figure.dataset[key]));
  }
  for (const part of document.querySelectorAll(".target")) part.hidden = !fits("target", part.dataset.target);
  // A verdict leaves the matrix whole and fades the other cells.
  for (const cell of document.querySelectorAll("table.matrix td[data-r]")) {
    cell.classList.toggle("faded", !fits("verdict", verdictText(cell)));
  }
};

const verdictText = (cell) => {
  const text = cell.textContent.toLowerCase();
  return text.startsWith("?") ? "doubtful" : text;
};

const select = (label, key, values, changed) => {
  const wrapper = document.createElement("span");
  const name = document.createElement("label");
  const list = document.createElement("select");
  list.id = `choose-${key}`;
  name.htmlFor = list.id;
  name.textContent = label;
  list.append(new Option("all", ""), ...values.map((value) => new Option(value, value)));
  list.addEventListener("change", () => changed(list.value));
  wrapper.append(name, " ", list);
  return { wrapper, list };
};

export const addFilters = () => {
  const all = (key) => names([...document.querySelectorAll(`[data-${key}]`)].map((part) => part.dataset[key]));
  const choices = [
    ["Scene", "scene", all("scene")],
    ["Camera", "camera", valuesOf("camera")],
    ["Target", "target", valuesOf("target")],
    ["Lamps", "lamps", all("lamps")],
    ["Verdict", "verdict", valuesOf("verdict")],
  ].filter(([, , values]) => values.length > 1);
  if (choices.length === 0) return;
  const bar = document.createElement("search");
  bar.setAttribute("role", "search");
  bar.setAttribute("aria-label", "Choose what is shown");
  bar.className = "filters";
  const chosen = {};
  const lists = [];
  for (const [label, key, values] of choices) {
    const { wrapper, list } = select(label, key, values, (value) => {
      chosen[key] = value;
      apply(chosen);
    });
    bar.append(wrapper);
    lists.push(list);
  }
  const clear = document.createElement("button");
  clear.type = "button";
  clear.textContent = "Show all";
  clear.addEventListener("click", () => {
    for (const list of lists) list.value = "";
    for (const key of Object.keys(chosen)) delete chosen[key];
    apply(chosen);
  });
  bar.append(clear);
  document.getElementById("summary").querySelector("h2").after(bar);
};
