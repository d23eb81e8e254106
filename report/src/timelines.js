// SPDX-License-Identifier: Apache-2.0
// Timelines as SVG: probabilities above, luminance below, eclipse and penumbra shaded. Drawn when
// they come into view, as a study may have many.
import {
  axisX,
  axisY,
  dot,
  gridY,
  line,
  plot,
  pointerX,
  rect,
  ruleX,
  ruleY,
  tip,
} from "@observablehq/plot";

const series = [
  { key: "detect", name: "detect", className: "s0", dash: null, symbol: "circle" },
  { key: "recognise", name: "recognise", className: "s1", dash: "7 3", symbol: "square" },
  { key: "identify", name: "identify", className: "s2", dash: "2 3", symbol: "triangle" },
];

const colour = (k) => `var(--series-${k})`;

// Neighbours in the same shade as one band, out to the middle between places.
const bands = (x, sun) => {
  const shade = (share) =>
    share === null || share === undefined || share >= 1 ? "" : share > 0 ? "penumbra" : "eclipse";
  const middle = (k) => {
    if (k <= 0) return x[0];
    return k >= x.length ? x[x.length - 1] : (x[k - 1] + x[k]) / 2;
  };
  const found = [];
  for (let k = 0; k < x.length; ) {
    let end = k + 1;
    while (end < x.length && shade(sun[end]) === shade(sun[k])) ++end;
    if (shade(sun[k])) found.push({ shade: shade(sun[k]), from: middle(k), to: middle(end) });
    k = end;
  }
  return found;
};

const shading = (found) =>
  rect(found, {
    x1: "from",
    x2: "to",
    fill: (band) => `var(--${band.shade})`,
    stroke: "none",
  });

const xAxis = (data) => ({
  label: data.axis === "position" ? "position in the orbit (°)" : "time (s)",
  domain: [Math.min(...data.x), Math.max(...data.x)],
});

// Of an orbit every 60 degrees, else what the library finds.
const xTicks = (data) => {
  const [from, to] = xAxis(data).domain;
  if (data.axis !== "position" || to - from < 180) return undefined;
  return [0, 60, 120, 180, 240, 300, 360].filter((tick) => tick >= from && tick <= to);
};

// Decades, at most five of them.
const decades = (values) => {
  const [from, to] = [Math.floor(Math.log10(Math.min(...values))), Math.ceil(Math.log10(Math.max(...values)))];
  const step = Math.ceil((to - from) / 4);
  const ticks = [];
  for (let power = from; power <= to; power += step) ticks.push(10 ** power);
  return ticks;
};

const common = { marginLeft: 52, marginRight: 14, style: { fontSize: "11px", fontFamily: "inherit" } };

const probabilities = (data, title, width) => {
  const rows = data.x.map((x, k) => ({
    x,
    ...Object.fromEntries(series.map(({ key }) => [key, data[key][k]])),
  }));
  const few = rows.length <= 48;
  return plot({
    ...common,
    width,
    height: 165,
    ariaLabel: `Probabilities: ${title}`,
    x: xAxis(data),
    y: { domain: [0, 1], label: "probability" },
    marks: [
      shading(bands(data.x, data.sun)),
      gridY({ strokeOpacity: 0.25, ticks: [0, 0.5, 1] }),
      axisX({ label: null, ticks: xTicks(data), tickFormat: () => "" }),
      axisY({ ticks: [0, 0.5, 1], tickFormat: String }),
      ...series.map(({ key, dash }, k) =>
        line(rows, { x: "x", y: key, stroke: colour(k), strokeWidth: 2, strokeDasharray: dash }),
      ),
      ...(few
        ? series.map(({ key, symbol }, k) =>
            dot(rows, { x: "x", y: key, fill: colour(k), symbol, r: 2.5 }),
          )
        : []),
      ruleX(rows, pointerX({ x: "x", strokeOpacity: 0.5 })),
      tip(
        rows,
        pointerX({
          x: "x",
          y: "detect",
          fill: "var(--page)",
          title: (row) =>
            `${row.x}${data.axis === "position" ? "°" : " s"}\n` +
            series.map(({ key, name }) => `${name} ${row[key] ?? "–"}`).join("\n"),
        }),
      ),
    ],
  });
};

const luminance = (data, title, width) => {
  const rows = data.x.map((x, k) => ({ x, y: data.luminance[k] }));
  const positive = rows.map((row) => row.y).filter((y) => y > 0);
  const wide = positive.length > 0 && Math.max(...positive) > 20 * Math.min(...positive);
  if (wide) for (const row of rows) if (!(row.y > 0)) row.y = null;
  const ticks = wide ? decades(positive) : 4;
  return plot({
    ...common,
    width,
    height: 140,
    marginBottom: 36,
    ariaLabel: `Luminance: ${title}`,
    x: xAxis(data),
    y: {
      type: wide ? "log" : "linear",
      label: "luminance (cd/m²)",
      ...(wide ? { domain: [ticks[0], Math.max(ticks.at(-1), ...positive)] } : { zero: true, nice: true }),
    },
    marks: [
      shading(bands(data.x, data.sun)),
      gridY({ strokeOpacity: 0.25, ticks }),
      axisX({ ticks: xTicks(data), labelAnchor: "center" }),
      axisY({ ticks, tickFormat: (value) => String(Number(value.toPrecision(3))) }),
      ...(wide ? [] : [ruleY([0])]),
      line(rows, { x: "x", y: "y", stroke: "var(--text)", strokeWidth: 1.5 }),
      ...(rows.length <= 48 ? [dot(rows, { x: "x", y: "y", fill: "var(--text)", r: 2 })] : []),
      tip(
        rows,
        pointerX({
          x: "x",
          y: "y",
          fill: "var(--page)",
          title: (row) => `${row.x}: ${row.y} cd/m²`,
        }),
      ),
    ],
  });
};

// The figures of a plot as a table, made when asked for.
const tableOf = (data, title) => {
  const columns = [
    [data.axis === "position" ? "position, °" : "time, s", data.x],
    ["Sun free", data.sun],
    ["P detect", data.detect],
    ["P recognise", data.recognise],
    ["P identify", data.identify],
    ["luminance, cd/m²", data.luminance],
    ["Weber", data.weber],
  ];
  const table = document.createElement("table");
  table.createCaption().textContent = title;
  const head = table.createTHead().insertRow();
  for (const [name] of columns) {
    const cell = document.createElement("th");
    cell.scope = "col";
    cell.textContent = name;
    head.append(cell);
  }
  const body = table.createTBody();
  data.x.forEach((_, k) => {
    const row = body.insertRow();
    columns.forEach(([, values], column) => {
      const cell = column === 0 ? document.createElement("th") : row.insertCell();
      if (column === 0) {
        cell.scope = "row";
        row.append(cell);
      }
      cell.textContent = values[k] ?? "–";
    });
  });
  return table;
};

const asTable = (data, title) => {
  const details = document.createElement("details");
  details.className = "screen";
  details.append(Object.assign(document.createElement("summary"), { textContent: "As a table" }));
  details.addEventListener("toggle", () => {
    if (!details.open || details.querySelector("table")) return;
    const holder = document.createElement("div");
    holder.className = "scroll";
    holder.tabIndex = 0;
    holder.setAttribute("role", "region");
    holder.setAttribute("aria-label", `Table: ${title}`);
    holder.append(tableOf(data, title));
    details.append(holder);
  });
  return details;
};

const hasPlot = ({ x, detect, luminance: light }) =>
  x.length > 1 && !x.includes(null) && [...detect, ...light].some((value) => value !== null);

const draw = (figure, data) => {
  const title = figure.querySelector("figcaption").textContent;
  const charts = figure.querySelector(".charts");
  if (!charts || charts.childElementCount > 0) return;
  const width = Math.min(480, Math.max(320, charts.clientWidth || 480));
  const drawings = [probabilities(data, title, width)];
  if (data.luminance.some((value) => value !== null)) drawings.push(luminance(data, title, width));
  for (const drawing of drawings) {
    // One picture with one name: names of its parts are not read out, and not allowed either.
    drawing.setAttribute("role", "img");
    for (const part of drawing.querySelectorAll("[aria-label]")) part.removeAttribute("aria-label");
  }
  charts.append(...drawings);
};

const legend = () => {
  const list = document.createElement("ul");
  list.className = "legend";
  list.setAttribute("aria-label", "Lines and shades");
  const sample = (html, name) => {
    const item = document.createElement("li");
    const template = document.createElement("template");
    template.innerHTML = `<svg aria-hidden="true" width="34" height="14">${html}</svg>`;
    item.append(template.content, ` ${name}`);
    list.append(item);
  };
  series.forEach(({ name, dash }, k) =>
    sample(
      `<path d="M1 7H33" stroke="${colour(k)}" stroke-width="2.5" ${dash ? `stroke-dasharray="${dash}"` : ""}/>`,
      name,
    ),
  );
  for (const shade of ["eclipse", "penumbra"]) {
    sample(`<rect width="34" height="14" fill="var(--${shade})"/>`, shade);
  }
  return list;
};

export const drawTimelines = (lines) => {
  const figures = [...document.querySelectorAll(".timeline")];
  if (figures.length === 0) return { drawAll: () => {} };
  document.querySelector(".timelines").before(legend());
  const drawOne = (figure) => draw(figure, lines[Number(figure.dataset.line)]);
  const watch = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        if (!isIntersecting) continue;
        watch.unobserve(target);
        drawOne(target);
      }
    },
    { rootMargin: "600px" },
  );
  for (const figure of figures) {
    const data = lines[Number(figure.dataset.line)];
    if (!hasPlot(data)) continue; // its words say all there is
    const charts = document.createElement("div");
    charts.className = "charts";
    figure.querySelector("figcaption").after(charts);
    figure.append(asTable(data, figure.querySelector("figcaption").textContent));
    watch.observe(figure);
  }
  // The rest while nothing else is to do, so that whoever scrolls fast, or keeps the page as a
  // picture, has them too. What is folded is drawn once it shows.
  const idle = window.requestIdleCallback ?? ((work) => setTimeout(work, 50));
  const waiting = figures.filter((figure) => figure.querySelector(".charts"));
  const drawNext = () => {
    const figure = waiting.shift();
    if (!figure) return;
    if (figure.offsetParent) drawOne(figure);
    idle(drawNext);
  };
  idle(drawNext);
  return { drawAll: () => figures.forEach(drawOne) };
};
