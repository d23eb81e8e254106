// SPDX-License-Identifier: Apache-2.0
// Adds to a page that is complete without it: plots, sliders, sorting, filters, cell by cell
// reading of the matrix. Everything it shows is taken from the page.
import { addFilters } from "./filter.js";
import { fitPhone } from "./fold.js";
import { enhanceMatrices } from "./matrix.js";
import { enhancePairs } from "./pairs.js";
import { preparePrinting } from "./print.js";
import { enhanceSorting } from "./sort.js";
import { drawTimelines } from "./timelines.js";

document.documentElement.classList.add("scripted");
const data = JSON.parse(document.getElementById("data").textContent);
enhanceSorting();
enhanceMatrices();
enhancePairs();
const timelines = drawTimelines(data.timelines);
addFilters();
fitPhone();
preparePrinting(timelines);
