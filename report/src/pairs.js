// SPDX-License-Identifier: Apache-2.0
// A pair's pictures on top of each other under a slider, in place of side by side.
import "img-comparison-slider";

const enhance = (pair) => {
  const sides = pair.querySelector(".sides");
  const [left, right] = [...sides.querySelectorAll("figure")].map((figure) => ({
    image: figure.querySelector("img"),
    caption: figure.querySelector("figcaption").textContent,
  }));
  const slider = document.createElement("img-comparison-slider");
  slider.setAttribute("role", "slider");
  slider.setAttribute("aria-orientation", "horizontal");
  slider.setAttribute("aria-label", pair.querySelector("figcaption").textContent);
  slider.setAttribute("aria-valuemin", "0");
  slider.setAttribute("aria-valuemax", "100");
  const tell = () => {
    const share = Math.round(slider.value);
    slider.setAttribute("aria-valuenow", String(share));
    slider.setAttribute("aria-valuetext", `${share} % ${left.caption}, the rest ${right.caption}`);
  };
  for (const [slot, side] of [["first", left], ["second", right]]) {
    const image = side.image.cloneNode();
    image.slot = slot;
    image.alt = "";
    slider.append(image);
  }
  slider.addEventListener("slide", tell);
  // The component knows the arrows; the ends and larger steps are what else a slider should know.
  slider.addEventListener("keydown", (event) => {
    const to = { Home: 0, End: 100, PageUp: slider.value + 10, PageDown: slider.value - 10 }[event.key];
    if (to === undefined) return;
    slider.value = Math.min(100, Math.max(0, to));
    tell();
    event.preventDefault();
  });
  tell();

  const captions = document.createElement("div");
  captions.className = "ends";
  captions.setAttribute("aria-hidden", "true"); // the slider's value says it
  for (const side of [left, right]) {
    const end = document.createElement("span");
    end.textContent = side.caption;
    captions.append(end);
  }
  const frame = document.createElement("div");
  frame.className = "slider";
  frame.append(slider, captions);
  sides.before(frame);
};

export const enhancePairs = () => {
  const pairs = document.querySelectorAll(".pair");
  if (pairs.length === 0) return;
  for (const pair of pairs) enhance(pair);
  const toggle = document.createElement("button");
  toggle.type = "button";
  toggle.className = "toggle";
  toggle.textContent = "Show pairs side by side";
  toggle.setAttribute("aria-pressed", "false");
  toggle.addEventListener("click", () => {
    const apart = toggle.getAttribute("aria-pressed") === "false";
    toggle.setAttribute("aria-pressed", String(apart));
    document.documentElement.classList.toggle("apart", apart);
  });
  document.querySelector(".pairs").before(toggle);
};
