// SPDX-License-Identifier: BSD-3-Clause
// The style sheet of the report page.
#pragma once

namespace csom {

constexpr char kReportStyle[] = R"css(
:root {
  color-scheme: light dark;
  --ink: #1d2430; --soft: #5b6675; --page: #ffffff; --panel: #f4f6f8; --rule: #d9dee4;
  --accent: #2563a8; --warn: #8a5300; --warn-panel: #fff6e5;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ink: #e6e9ee; --soft: #9aa5b4; --page: #14181e; --panel: #1d232c; --rule: #343d49;
    --accent: #6fa8e8; --warn: #f0c27b; --warn-panel: #2c2415;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 1.5rem 1rem 3rem; max-width: 62rem;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif;
  color: var(--ink); background: var(--page);
}
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 .75rem; overflow-wrap: anywhere; }
h2 { font-size: 1.15rem; margin: 2.25rem 0 .6rem; }
p { margin: .5rem 0; max-width: 46rem; }
.lead { font-size: 1.08rem; }
.soft { color: var(--soft); }
.figures {
  display: grid; grid-template-columns: repeat(auto-fit, minmax(8.8rem, 1fr)); gap: .75rem;
  margin: 1.25rem 0 0; padding: 0;
}
.figures div { background: var(--panel); border-radius: .5rem; padding: .7rem .9rem; }
.figures dt { color: var(--soft); font-size: .85rem; }
.figures dd { margin: 0; font-size: 1.25rem; font-variant-numeric: tabular-nums; }
figure { margin: 0; }
figure img {
  display: block; max-width: 100%; height: auto; margin: 0 auto; background: #fff;
  border: 1px solid var(--rule); border-radius: .5rem;
}
figcaption { color: var(--soft); font-size: .9rem; margin-top: .4rem; }
.pair { display: grid; grid-template-columns: 1fr; gap: .5rem; margin: 1rem 0 1.5rem; }
.pair img { width: 100%; }
.pair figcaption { grid-column: 1 / -1; margin: 0; }
.legend { display: flex; flex-wrap: wrap; gap: .25rem 1.1rem; margin: .5rem 0; padding: 0; }
.legend { list-style: none; }
@media (min-width: 60rem) {
  /* Two pictures side by side need more than the column of the text. */
  .pair {
    grid-template-columns: 1fr 1fr; width: min(96vw, 112rem); position: relative; left: 50%;
    transform: translateX(-50%);
  }
}
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .6rem; text-align: right; border-bottom: 1px solid var(--rule); }
th { color: var(--soft); font-weight: 600; font-size: .88rem; vertical-align: bottom; }
th.text, td.text { text-align: left; overflow-wrap: anywhere; }
td { white-space: nowrap; }
td.text { min-width: 8rem; white-space: normal; }
.swatch {
  display: inline-block; width: .9em; height: .9em; margin-right: .5em; vertical-align: -.08em;
  border: 1px solid var(--rule); border-radius: .2em; print-color-adjust: exact;
}
.bar { min-width: 6rem; width: 22%; }
.bar span {
  display: block; height: .7em; min-width: 1px; border-radius: .2em; background: var(--accent);
  print-color-adjust: exact;
}
ul.warnings { background: var(--warn-panel); color: var(--warn); border-radius: .5rem; }
ul.warnings { padding: .7rem 1rem .7rem 2.2rem; overflow-wrap: anywhere; }
pre {
  background: var(--panel); border-radius: .5rem; padding: .8rem 1rem; white-space: pre-wrap;
  overflow-wrap: anywhere; font-size: .9rem;
}
code { overflow-wrap: anywhere; }
summary { cursor: pointer; padding: .3rem 0; }
@media (max-width: 34rem) {
  body { padding: 1rem .75rem 2rem; }
  th, td { padding: .3rem .4rem; font-size: .92rem; }
}
@media print {
  body { max-width: none; padding: 0; }
  .pair { grid-template-columns: 1fr 1fr; width: auto; left: 0; transform: none; }
  h2 { break-after: avoid; }
  tr, figure, .figures div { break-inside: avoid; }
}
)css";

}  // namespace csom
