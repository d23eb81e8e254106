// SPDX-License-Identifier: Apache-2.0
// Paper cannot be opened: everything is, and everything is drawn, while it is printed.

export const preparePrinting = (timelines) => {
  let opened = [];
  addEventListener("beforeprint", () => {
    timelines.drawAll();
    opened = [...document.querySelectorAll("details:not([open]):not(.unprinted)")];
    for (const part of opened) part.open = true;
  });
  addEventListener("afterprint", () => {
    for (const part of opened) part.open = false;
  });
};
