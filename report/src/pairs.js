// SPDX-License-Identifier: Apache-2.0
// Pairs of the page's pictures on top of each other under a slider, and the buttons that show them
// side by side or all by one exposure.
import "img-comparison-slider";

const root = document.documentElement;

// What a picture shows at present: by its own white, or by one for all.
const shown = (figure) =>
  (root.classList.contains("same-exposure") && figure.querySelector("img.same")) || figure.querySelector("img.own");

const enhance = (pair) => {
  const [left, right] = [...pair.querySelectorAll("span")].map((caption, k) => ({
    figure: document.getElementById(k === 0 ? pair.dataset.left : pair.dataset.right),
    caption: caption.textContent,
  }));
  const title = pair.querySelector("strong").textContent;
  const slider = document.createElement("img-comparison-slider");
  slider.setAttribute("role", "slider");
  slider.setAttribute("aria-orientation", "horizontal");
  slider.setAttribute("aria-label", title);
  slider.setAttribute("aria-valuemin", "0");
  slider.setAttribute("aria-valuemax", "100");
  const say = () => {
    const share = Math.round(slider.value);
    slider.setAttribute("aria-valuenow", String(share));
    slider.setAttribute("aria-valuetext", `${share} % ${left.caption}, the rest ${right.caption}`);
  };
  const ends = document.createElement("div");
  ends.className = "ends";
  ends.setAttribute("aria-hidden", "true"); // the slider's value says it
  for (const [slot, side] of [["first", left], ["second", right]]) {
    side.image = Object.assign(document.createElement("img"), { slot, alt: "" });
    slider.append(side.image);
    side.end = document.createElement("span");
    ends.append(side.end);
  }
  const expose = () => {
    for (const side of [left, right]) {
      side.image.src = shown(side.figure).src;
      const kind = shown(side.figure).className;
      const exposure = side.figure.querySelector(`.ev.${kind}`)?.textContent ?? "";
      side.end.textContent = exposure ? `${side.caption}: ${exposure}` : side.caption;
    }
  };
  slider.addEventListener("slide", say);
  // The component knows the arrows; the ends and larger steps are what else a slider should know.
  slider.addEventListener("keydown", (event) => {
    const to = { Home: 0, End: 100, PageUp: slider.value + 10, PageDown: slider.value - 10 }[event.key];
    if (to === undefined) return;
    slider.value = Math.min(100, Math.max(0, to));
    say();
    event.preventDefault();
  });
  say();
  expose();
  pair.replaceChildren(Object.assign(document.createElement("strong"), { textContent: title }), slider, ends);
  return expose;
};

// A button that switches a class of the page on and off.
const toggle = (text, name, changed = () => {}) => {
  const button = Object.assign(document.createElement("button"), { type: "button", className: "toggle", textContent: text });
  button.setAttribute("aria-pressed", "false");
  button.addEventListener("click", () => {
    button.setAttribute("aria-pressed", String(root.classList.toggle(name)));
    changed();
  });
  return button;
};

export const enhancePairs = () => {
  const exposures = [...document.querySelectorAll(".pairs li")].map(enhance);
  const buttons = [];
  if (exposures.length > 0) buttons.push(toggle("Show pairs side by side", "apart"));
  if (document.querySelector(".twice")) {
    buttons.push(toggle("Same exposure", "same-exposure", () => exposures.forEach((expose) => expose())));
  }
  document.querySelector("#pictures h2")?.after(...buttons);
};
