// SPDX-License-Identifier: Apache-2.0
// What the pages of `earthshine view` share: their data, the scale of false colours, the facts of the file.
const byId = (id) => document.getElementById(id);
const data = JSON.parse(byId("data").textContent);

// top: the power of ten of the brightest colour.
const showScale = (top, unit) => {
  byId("ramp").style.background = `linear-gradient(${falseAnchors.map((hex) => `#${hex}`).reverse().join(",")})`;
  byId("unit").textContent = unit;
  byId("marks").replaceChildren(...Array.from({ length: falseDecades + 1 }, (_, k) => {
    const mark = document.createElement("span");
    mark.textContent = (10 ** (top - k)).toPrecision(2);
    return mark;
  }));
};

const showFile = () => {
  byId("name").textContent = data.name;
  for (const layer of data.layers) byId("layer").add(new Option(layer.name));
  for (const [name, value] of data.facts) {
    for (const [tag, text] of [["dt", name], ["dd", value]]) {
      byId("facts").append(Object.assign(document.createElement(tag), { textContent: text }));
    }
  }
};

const showProblem = (error) => {
  byId("problem").hidden = false;
  byId("problem").textContent = `The page cannot show its data: ${error.message}`;
};
